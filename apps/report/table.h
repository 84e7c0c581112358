// Tables of a report.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"

namespace delray::apps::report {

struct Column {
  std::string name;      // with the unit
  bool number = true;    // aligned to the right
  bool labelled = true;  // whether `source` is shown
  Source source = Source::counted;
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  // one text for each column
  int emphasised = -1;                         // number of a row
};

// Columns are sorted by a click on their head.
Html table(const Table& table);

}  // namespace delray::apps::report
