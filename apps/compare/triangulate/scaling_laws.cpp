// What is measured, and what formulas make of it: Kohout (2004), 2.1 to 2.5; Karp and Flatt (1990).
#include "apps/compare/triangulate/scaling_laws.h"

#include <fmt/format.h>

#include <utility>

#include "apps/compare/scaling_limit.h"
#include "apps/report/page.h"
#include "apps/report/table.h"
#include "parallel/speed_up.h"

namespace delray::apps {

using namespace report;

Html scaling_laws(const ComparedTriangulations& all, const ComparedTriangulations& rows) {
  Table numbers;
  numbers.columns = {{"method", false, false, {}}, {"threads", true, false, {}}};
  for (Column& column : speed_up_columns(Source::measured)) {
    numbers.columns.push_back(std::move(column));
  }
  numbers.columns.push_back({"at most, by Amdahl", true, true, Source::predicted});
  for (const ComparedTriangulation& row : rows) {
    const ComparedTriangulation* base = base_of(all, row);
    if (base == nullptr || row.how.threads == 1 || !(row.seconds.median > 0)) continue;
    const double gain = parallel::speed_up(base->seconds.median, row.seconds.median);
    const double fraction = parallel::serial_fraction(gain, row.how.threads);
    std::vector<std::string> line = {name_of(row.how), std::to_string(row.how.threads)};
    for (std::string& cell : speed_up_cells(gain, row.how.threads)) line.push_back(std::move(cell));
    line.push_back(fraction > 0 ? fmt::format("{:.3g}", parallel::amdahl_limit(1 - fraction))
                                : "-");
    numbers.rows.push_back(std::move(line));
  }
  if (numbers.rows.empty()) return {};
  return heading("What Amdahl's law makes of it") + table(numbers) +
         paragraph(
             "With times t(k) of k threads: the speed-up is s = t(1) / t(k), the efficiency s / k. "
             "Amdahl's law says s = 1 / (q / k + 1 - q) where a fraction q of the work is "
             "parallel; "
             "the sequential fraction 1 - q that follows from what was measured is (1 / s - 1 / k) "
             "/ (1 - 1 / k) (Karp and Flatt). Where it stays the same with more threads, the work "
             "itself is sequential to that part, and no number of threads is more than 1 / (1 - q) "
             "times as fast; where it grows, threads wait for each other. It is negative, and "
             "there is no limit, where the speed-up is super-linear.");
}

}  // namespace delray::apps
