// One function builds each tab of the page: what is sent, what ranks wait for, what they share, the
// times that networks would take.
#include "apps/compare/triangulate/distributed_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "apps/compare/triangulate/distributed_figures.h"
#include "apps/compare/triangulate/triangulate_report.h"
#include "apps/compare/variant_looks.h"
#include "apps/report/chart.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

using namespace report;
using DistributedRow = ComparedDistributedMethod;
using RowQuantity = std::function<std::optional<double>(const DistributedRow&)>;

report::Look look_of_distributed(const std::string& name) {
  return look_of(Family::distributed, name);
}

Html distributed_chart(const std::vector<DistributedRow>& rows, const std::string& title,
                       const std::string& label, Source source, const RowQuantity& x,
                       const RowQuantity& y, const std::string& x_label) {
  std::vector<Series> series = series_by(
      rows, [](const DistributedRow& row) { return row.method; }, look_of_distributed, source,
      [&](const DistributedRow& row) -> std::optional<ChartPoint> {
        const auto at = x(row), value = y(row);
        if (!at || !value) return std::nullopt;
        return ChartPoint{*at, *value, *value, *value};
      });
  return series.empty() ? Html() : logarithmic_chart(title, x_label, label, std::move(series));
}

// Over the ranks, with all points.
class OverRanks {
 public:
  explicit OverRanks(const DistributedComparison& comparison) : comparison_(comparison) {}

  Html chart(const std::string& title, const std::string& label, Source source,
             const RowQuantity& y) const {
    std::vector<DistributedRow> rows;
    std::ranges::copy_if(
        comparison_.rows, std::back_inserter(rows),
        [&](const DistributedRow& row) { return row.points == comparison_.points; });
    return distributed_chart(
        rows, title, label, source, [](const DistributedRow& row) { return double(row.ranks); }, y,
        "ranks");
  }

 private:
  const DistributedComparison& comparison_;
};

Html messages_tab(const OverRanks& over) {
  return in_columns(
             {over.chart("Messages of all ranks", "messages", Source::counted,
                         [](const DistributedRow& row) { return double(row.sum.messages); }),
              over.chart("Bytes of all ranks", "bytes", Source::counted,
                         [](const DistributedRow& row) { return double(row.sum.bytes); }),
              over.chart("Bytes that one rank sends at most", "bytes", Source::counted,
                         [](const DistributedRow& row) { return double(row.bytes_sent_max); })}) +
         paragraph(
             "Counted while the points go to the ranks that have their areas, too. Messages "
             "of a rank to itself are left out.");
}

Html waiting_tab(const DistributedComparison& comparison, const OverRanks& over) {
  return in_columns(
             {over.chart("Answers that ranks wait for", "waits", Source::counted,
                         [](const DistributedRow& row) { return double(row.sum.waits); }),
              over.chart("Share of the time that ranks wait", "share", Source::predicted,
                         [](const DistributedRow& row) -> std::optional<double> {
                           if (row.predicted.empty() || row.predicted[0].seconds <= 0)
                             return std::nullopt;
                           return row.sum.waiting_seconds / (row.predicted[0].seconds * row.ranks);
                         }),
              over.chart("Insertions that were rolled back", "rollbacks", Source::counted,
                         [](const DistributedRow& row) { return double(row.sum.rollbacks); })}) +
         paragraph(fmt::format("Of runs over {}. Methods that exchange in rounds wait for no "
                               "single answer.",
                               comparison.networks[0].name));
}

Html shared_tab(const DistributedComparison& comparison, const OverRanks& over) {
  std::vector<DistributedRow> rows;
  std::ranges::copy_if(comparison.rows, std::back_inserter(rows), [&](const DistributedRow& row) {
    return row.ranks == two_areas(row.method);
  });
  std::ranges::stable_sort(
      rows, [](const DistributedRow& a, const DistributedRow& b) { return a.points < b.points; });
  return in_columns({distributed_chart(
                         rows, "Shared simplices of two areas", "simplices", Source::counted,
                         [](const DistributedRow& row) { return std::sqrt(double(row.points)); },
                         [](const DistributedRow& row) { return double(row.sum.shared_simplices); },
                         "square root of the points"),
                     over.chart("Shared simplices", "simplices", Source::counted,
                                [](const DistributedRow& row) {
                                  return double(row.sum.shared_simplices);
                                })}) +
         paragraph(
             "A simplex is shared if its corners lie in the areas of several ranks; for "
             "hardwick and lee-2001 if one lies on a path between two. Of uniform points in "
             "the plane there are some times the square root of the points (Kohout 2004, "
             "Figure 8.3): straight lines of slope 1. Of "
             "interface-workers one rank has no area.");
}

Html predictions_tab(const DistributedComparison& comparison, const OverRanks& over) {
  std::vector<Html> charts;
  for (std::size_t i = 0; i < comparison.networks.size(); ++i) {
    charts.push_back(over.chart(fmt::format("Time over {}", comparison.networks[i].name),
                                "time, ms", Source::predicted,
                                [i](const DistributedRow& row) -> std::optional<double> {
                                  if (i >= row.predicted.size()) return std::nullopt;
                                  return row.predicted[i].seconds * 1e3;
                                }));
  }
  return in_columns(charts) +
         paragraph(
             "Every rank has a core of its own as fast as this machine's, on which its code "
             "really ran. From points on their ranks to simplices on theirs.");
}

Html all_figures_tab(const DistributedComparison& comparison) {
  const TextTable text = distributed_table(comparison);
  Table result;
  for (const std::string& name : text[0]) {
    const bool predicted = name.ends_with("predicted");
    const bool given = name == "method" || name == "points" || name == "ranks";
    result.columns.push_back(
        {name, name != "method", !given, predicted ? Source::predicted : Source::counted});
  }
  result.rows.assign(text.begin() + 1, text.end());
  return table(result);
}

// The method that is predicted to take least on most ranks, for each network.
Html distributed_answer(const DistributedComparison& comparison) {
  std::vector<const DistributedRow*> rows;
  int ranks = 0;
  for (const DistributedRow& row : comparison.rows) {
    if (row.points == comparison.points) ranks = std::max(ranks, row.ranks);
  }
  for (const DistributedRow& row : comparison.rows) {
    if (row.points == comparison.points && row.ranks == ranks) rows.push_back(&row);
  }
  Html answer;
  for (std::size_t i = 0; !rows.empty() && i < comparison.networks.size(); ++i) {
    std::ranges::sort(rows, [i](const DistributedRow* a, const DistributedRow* b) {
      return a->predicted[i].seconds < b->predicted[i].seconds;
    });
    answer += fmt::format(
        "<p>On {} ranks over {} {} takes {:.2f} ms (predicted), with {} messages and {} bytes "
        "(counted){}.</p>\n",
        ranks, comparison.networks[i].name, strong(rows[0]->method),
        rows[0]->predicted[i].seconds * 1e3, rows[0]->sum.messages,
        short_number(static_cast<double>(rows[0]->sum.bytes)),
        rows.size() > 1
            ? fmt::format("; {} {:.2f}", rows[1]->method, rows[1]->predicted[i].seconds * 1e3)
            : std::string());
  }
  const bool alike = std::ranges::all_of(
      rows, [&](const DistributedRow* row) { return row->hash == rows.front()->hash; });
  answer += paragraph(alike ? "All methods give the same simplices (hash " +
                                  (rows.empty() ? std::string("-") : rows.front()->hash) + ")."
                            : std::string("Methods give different simplices: that is an error."));
  if (!comparison.left_out.empty()) {
    std::string names;
    for (const std::string& name : comparison.left_out) {
      names += (names.empty() ? "" : "; ") + name;
    }
    answer +=
        paragraph("Left out, as they take too long to simulate or too much memory: " + names + ".");
  }
  return answer;
}

}  // namespace

std::string distributed_report(const Session& session, const TriangulateRequest& request,
                               const DistributedComparison& comparison) {
  const OverRanks over(comparison);
  Page result = page_of_triangulations(
      session, request,
      fmt::format(" by ranks, {} points in {}D", comparison.points, comparison.dim));
  result.unfinished = comparison.unfinished;
  result.answer = distributed_answer(comparison);
  result.tabs.push_back({"Messages", messages_tab(over)});
  result.tabs.push_back({"Waiting", waiting_tab(comparison, over)});
  result.tabs.push_back({"Shared simplices", shared_tab(comparison, over)});
  result.tabs.push_back({"Predictions", predictions_tab(comparison, over)});
  result.tabs.push_back({"All figures", all_figures_tab(comparison)});
  result.data = distributed_statistics(request, comparison);
  return page(result);
}

}  // namespace delray::apps
