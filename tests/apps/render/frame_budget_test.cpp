// Bounds of error for frames in time, on machines that are made up.
#include "apps/render/frame_budget.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace delray::apps {
namespace {

// A scene and a machine: triangles by error, seconds by triangles.
struct Machine {
  double most = 2e6, power = 1.3, own = 0.012, each = 40e-9, noise = 0;
  std::mt19937 random{20261127};

  double triangles(double error) const { return most / std::pow(1 + 2 * error, power); }
  double seconds(double triangles) {
    std::uniform_real_distribution<double> jitter(1 - noise, 1 + noise);
    return (own + each * triangles) * jitter(random);
  }
};

// The seconds that each of so many frames took.
std::vector<double> run(double budget, Machine machine, int frames, double first = 0) {
  FrameBudget control(budget);
  std::vector<double> seconds;
  for (int i = 0; i < frames; ++i) {
    const double triangles = machine.triangles(control.error());
    seconds.push_back(machine.seconds(triangles) + (i == 0 ? first : 0));
    control.took(seconds.back(), static_cast<std::uint64_t>(triangles));
  }
  return seconds;
}

TEST(FrameBudget, IsMetWithinAFewFrames) {
  for (const double own : {0.001, 0.012, 0.02}) {
    for (const double power : {0.6, 1.3, 2.0}) {
      Machine machine;
      machine.own = own;
      machine.power = power;
      const std::vector<double> seconds = run(0.03, machine, 20, 0.2);  // the first reads pages
      for (std::size_t i = 10; i < seconds.size(); ++i) {
        EXPECT_LE(seconds[i], 0.03) << own << " " << power << " " << i;
        EXPECT_GE(seconds[i], 0.022) << own << " " << power << " " << i;
      }
    }
  }
}

TEST(FrameBudget, IsMetOnAverageOnANoisyMachine) {
  Machine machine;
  machine.noise = 0.15;
  const std::vector<double> seconds = run(0.03, machine, 60);
  double sum = 0;
  for (std::size_t i = 20; i < seconds.size(); ++i) {
    sum += seconds[i];
    EXPECT_LE(seconds[i], 0.05) << i;
  }
  EXPECT_NEAR(sum / 40, 0.027, 0.006);
}

TEST(FrameBudget, ThatNoLevelMeetsComesAsCloseAsItCan) {
  Machine machine;
  machine.own = 0.1;
  const std::vector<double> seconds = run(0.03, machine, 40);
  for (std::size_t i = 15; i < seconds.size(); ++i) EXPECT_LE(seconds[i], 0.12) << i;
}

TEST(FrameBudget, ThatIsAmpleShowsEverything) {
  FrameBudget control(100);
  for (int i = 0; i < 20; ++i) control.took(0.02, 100000);
  EXPECT_EQ(control.error(), FrameBudget::kLeast);
}

}  // namespace
}  // namespace delray::apps
