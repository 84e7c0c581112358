// What locks are made of: the same simplices, and counts that tell the kinds apart.
#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <thread>

#include "delaunay/generate.h"
#include "delaunay/history/critical_section.h"
#include "delaunay/methods.h"
#include "parallel/team.h"
#include "tests/delaunay/same_simplices.h"

namespace delray::delaunay {
namespace {

constexpr std::uint64_t kLocksSeed = 20261128;

Synchronization counts_of_locks(int dim, const std::string& method, const std::string& locks,
                                int threads) {
  const PointCloud points = generate_points("uniform", 2000, dim, kLocksSeed);
  Options options;
  options.dim = dim;
  options.method = method;
  options.locks = locks;
  options.threads = threads;
  options.statistics = true;
  return triangulate(view(points.positions), options).statistics.synchronization;
}

TEST(LockKinds, MakeTheSameSimplicesWithMoreThreadsThanCores) {
  for (const int dim : {2, 3}) {
    for (const char* const kind : {"uniform", "grid", "arc"}) {
      const auto points = generate_points(kind, dim == 2 ? 2000 : 500, dim, kLocksSeed).positions;
      const Triangulation expected = expected_of(points, dim);
      for (const Method& method : methods()) {
        for (const std::string_view locks : method.locks) {
          Options options;
          options.dim = dim;
          options.method = method.name;
          options.locks = locks;
          options.seed = kLocksSeed;
          options.threads = 7;
          ASSERT_NO_FATAL_FAILURE(expect_same(points, expected, options, kind));
        }
      }
    }
  }
}

TEST(LockKinds, CountMutexes) {
  for (const char* const method : {"optimistic", "burglary"}) {
    for (const int dim : {2, 3}) {
      SCOPED_TRACE(std::string(method) + ", " + std::to_string(dim) + "D");
      const Synchronization atomic = counts_of_locks(dim, method, "atomic", 3);
      EXPECT_EQ(atomic.mutex_locks, 0U);
      EXPECT_EQ(atomic.mutex_bytes, 0U);
      const Synchronization alone = counts_of_locks(dim, method, "mutex", 1);
      EXPECT_EQ(alone.mutex_locks, alone.free);
      EXPECT_EQ(alone.mutex_waits, 0U);
      EXPECT_GT(alone.free, 2000U);
      const Synchronization one = counts_of_locks(dim, method, "mutex", 3);
      const Synchronization many = counts_of_locks(dim, method, "striped", 3);
      EXPECT_GE(one.mutex_locks, one.free);
      EXPECT_LE(one.mutex_waits, one.mutex_locks);
      EXPECT_GE(many.mutex_locks, many.free);
      EXPECT_EQ(many.mutex_bytes, 1024 * one.mutex_bytes);
    }
  }
  const Synchronization mutex = counts_of_locks(2, "pessimistic", "mutex", 3);
  EXPECT_EQ(mutex.mutex_locks, mutex.lock_calls);
  EXPECT_EQ(mutex.mutex_waits, mutex.waits);
  EXPECT_GT(mutex.mutex_bytes, 0U);
  EXPECT_EQ(counts_of_locks(2, "pessimistic", "atomic", 3).mutex_locks, 0U);
}

TEST(CriticalSection, LetsOneThreadInAtATime) {
  for (const bool by_mutex : {false, true}) {
    internal::CriticalSection section(by_mutex);
    constexpr std::uint64_t kThreads = 7, kTimes = 2000;
    std::uint64_t inside = 0;  // not atomic
    parallel::Team team;
    team.run(kThreads, [&](std::size_t) {
      for (std::uint64_t i = 0; i < kTimes; ++i) {
        const std::unique_lock alone(section);
        ++inside;
      }
    });
    EXPECT_EQ(inside, kThreads * kTimes);
    section.lock();
    bool entered = true;
    std::jthread([&] { entered = section.try_lock(); }).join();
    EXPECT_FALSE(entered);
    section.unlock();
    EXPECT_TRUE(section.try_lock());
    section.unlock();
  }
}

}  // namespace
}  // namespace delray::delaunay
