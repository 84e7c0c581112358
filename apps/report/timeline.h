// A Gantt chart of what each rank or thread did when.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"

namespace delray::apps::report {

struct Span {
  int kind = 0;               // index into Timeline::kinds
  double begin = 0, end = 0;  // seconds
  std::string note;           // on hover
};

struct Lane {
  std::string name;
  std::vector<Span> spans;  // by ascending begin, not overlapping
};

struct Timeline {
  std::string title;
  Source source = Source::measured;
  std::vector<std::string> kinds;  // at most 8
  std::vector<Lane> lanes;
  int idle = -1;  // the kind that is pale, if any
};

// A figure; time starts at 0 at the earliest span, in milliseconds.
Html timeline(const Timeline& timeline);

}  // namespace delray::apps::report
