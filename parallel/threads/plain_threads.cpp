// A team of threads takes task numbers from an atomic counter until none are left or one has
// thrown.
#include "parallel/threads/plain_threads.h"

#include <algorithm>
#include <atomic>

#include "parallel/arena.h"
#include "parallel/team.h"

namespace delray::parallel::internal {

void run_on_plain_threads(std::size_t tasks, FunctionRef<void(std::size_t)> f) {
  // Relaxed, so that counting orders nothing that the tasks do.
  std::atomic<std::size_t> next = 0;
  Team team;
  team.run(std::clamp<std::size_t>(tasks, 1, static_cast<std::size_t>(arena_threads())),
           [&](std::size_t) {
             for (std::size_t task;
                  (task = next.fetch_add(1, std::memory_order_relaxed)) < tasks;) {
               team.check();
               f(task);
             }
           });
}

}  // namespace delray::parallel::internal
