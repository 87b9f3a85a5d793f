#include "fuzz/feed_files.h"
#include "fuzz/feed_urdf.h"
#include "fuzz/replay.h"

namespace shallow_sand {
namespace {

TEST(Corpus, Scenes) { replay("scene", feedScene); }

TEST(Corpus, TerrainFiles) { replay("terrain", feedTerrain); }

TEST(Corpus, RobotDescriptions) { replay("urdf", feedUrdf); }

}  // namespace
}  // namespace shallow_sand
