// The text of a progress bar.
#pragma once

#include <cstdint>
#include <string>

namespace delray::apps {

// Where a task is after some seconds; `total` is 0 where it is not known.
struct TaskState {
  std::uint64_t done = 0, total = 0;
  double seconds = 0;
};

// "render: [####......]  40 %  12 s left". The time left is estimated from what is done, and not
// told before a second is over and a hundredth is done; without a total the time so far is told. Of
// at most `width` characters.
std::string progress_text(const std::string& what, const TaskState& state, std::size_t width);

}  // namespace delray::apps
