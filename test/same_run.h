#pragma once

#include <gtest/gtest.h>

#include "random_fields.h"

namespace shallow_sand {

/// Advances by the frames [begin, end), each until its end as a product: no sum of roundings.
inline void advanceFrames(Simulator& simulator, double frame, int begin, int end) {
  for (int number = begin; number < end; ++number) simulator.advanceTo((number + 1) * frame);
}

/// The same sand after the same steps.
inline void expectSameSandAndSteps(const Simulator& one, const Simulator& other) {
  expectSameBits(one.fields(), other.fields());
  EXPECT_EQ(one.time(), other.time());
  EXPECT_EQ(one.progress().steps, other.progress().steps);
  EXPECT_EQ(one.progress().repeated_steps, other.progress().repeated_steps);
  EXPECT_EQ(one.progress().last_step, other.progress().last_step);
  EXPECT_EQ(one.ledger().now, other.ledger().now);
}

/// Volumes that came and went, too.
inline void expectSameRun(const Simulator& one, const Simulator& other) {
  expectSameSandAndSteps(one, other);
  EXPECT_EQ(one.ledger().left, other.ledger().left);
  EXPECT_EQ(one.ledger().poured, other.ledger().poured);
}

/// Bodies have given the same momentum, and have done so from one beginning.
inline void expectSameGivenMomentum(const Simulator& one, const Simulator& other) {
  const std::vector<SandContact> contacts = one.contacts(one.fields());
  const std::vector<SandContact> others = other.contacts(other.fields());
  ASSERT_EQ(contacts.size(), others.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    EXPECT_EQ(contacts[k].given_momentum, others[k].given_momentum) << "body " << k;
}

/// The same, where sums of volumes before and after a snapshot are rounded on their own.
inline void expectSameButForRoundings(const Simulator& whole, const Simulator& parts) {
  expectSameSandAndSteps(whole, parts);
  EXPECT_NEAR(whole.ledger().poured, parts.ledger().poured, 1e-12 * (1.0 + whole.ledger().poured));
  EXPECT_NEAR(whole.ledger().left, parts.ledger().left, 1e-12 * (1.0 + whole.ledger().left));
}

}  // namespace shallow_sand
