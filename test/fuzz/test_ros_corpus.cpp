#include "fuzz/feed_messages.h"
#include "fuzz/feed_parameters.h"
#include "fuzz/replay.h"

namespace shallow_sand {
namespace {

TEST(RosCorpus, Parameters) { replay("parameters", feedParameters); }

TEST(RosCorpus, Messages) { replay("messages", feedMessages); }

}  // namespace
}  // namespace shallow_sand
