// Tables of amounts as squares whose shade tells the amount.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"

namespace delray::apps::report {

struct Matrix {
  std::string title;
  std::string row_name, column_name;  // of what rows and columns are, e.g. "from rank"
  std::string unit;                   // of the values
  Source source = Source::counted;
  int rows = 0, columns = 0;
  std::vector<double> values;  // row by row; 0 stays empty
};

// A figure. `most` is what the darkest shade stands for, so that figures may be compared; 0: the
// largest value.
Html matrix(const Matrix& matrix, double most = 0);

}  // namespace delray::apps::report
