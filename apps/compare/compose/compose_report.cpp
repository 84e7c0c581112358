// One function builds each tab of the page. A tab about a single run turns its recorded events into
// a timeline of the ranks and into matrices of the bytes that they sent each other.
#include "apps/compare/compose/compose_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "apps/compare/compose/compose_answer.h"
#include "apps/compare/compose/compose_figures.h"
#include "apps/compare/compose/growth_claims.h"
#include "apps/compare/compose/own_networks.h"
#include "apps/compare/compose/shown_scheme.h"
#include "apps/compare/variant_looks.h"
#include "apps/provenance.h"
#include "apps/report/chart.h"
#include "apps/report/matrix.h"
#include "apps/report/page.h"
#include "apps/report/series.h"
#include "apps/report/table.h"
#include "apps/report/timeline.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

using namespace report;

ChartPoint point_of(const ComparedScheme& row, const Spread& seconds) {
  return {static_cast<double>(row.ranks), seconds.median * 1e3, seconds.low * 1e3,
          seconds.high * 1e3};
}

using SchemePoint = std::function<std::optional<ChartPoint>(const ComparedScheme&)>;

// A line for each scheme with the codec.
std::vector<Series> series_of(const std::vector<ComparedScheme>& rows, const std::string& codec,
                              Source source, const SchemePoint& point) {
  std::vector<ComparedScheme> of_codec;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(of_codec),
               [&](const ComparedScheme& row) { return row.codec == codec; });
  return series_by(
      of_codec, [](const ComparedScheme& row) { return row.scheme; },
      [](const std::string& name) { return look_of(Family::scheme, name); }, source, point);
}

Html chart_over_ranks(const std::vector<ComparedScheme>& rows, const std::string& codec,
                      const std::string& title, const std::string& label, Source source,
                      const SchemePoint& point) {
  LineChart chart;
  chart.title = title + ", codec " + codec;
  chart.x_label = "ranks";
  chart.y_label = label;
  chart.x_scale = chart.y_scale = Scale::logarithmic;
  chart.ticks_at_points = true;
  chart.series = series_of(rows, codec, source, point);
  return chart.series.empty() ? Html() : line_chart(chart);
}

Html times(const std::vector<ComparedScheme>& rows) {
  std::vector<Html> charts;
  const auto add = [&](const std::string& codec, const std::string& title,
                       std::optional<Spread> ComparedScheme::*seconds) {
    charts.push_back(
        chart_over_ranks(rows, codec, title, "time, ms", Source::measured,
                         [seconds](const ComparedScheme& row) -> std::optional<ChartPoint> {
                           if (!(row.*seconds)) return std::nullopt;
                           return point_of(row, *(row.*seconds));
                         }));
  };
  for (const std::string& codec : codecs_of(rows)) {
    add(codec, "Compositing and gather on this machine", &ComparedScheme::total_seconds);
    add(codec, "Compositing alone on this machine", &ComparedScheme::compose_seconds);
  }
  return in_columns(charts) +
         paragraph(
             "Medians; the upright lines are the intervals in which they lie with 95 %, of fewer "
             "than six runs all of their spread. Times end when the last rank is done. More ranks "
             "than cores share the cores.");
}

Html bytes(const std::vector<ComparedScheme>& rows) {
  std::vector<Html> charts;
  const auto of = [](std::uint64_t composite::Counts::*amount) {
    return [amount](const ComparedScheme& row) -> std::optional<ChartPoint> {
      const double value = static_cast<double>(row.counts.*amount) / 1e6;
      return ChartPoint{static_cast<double>(row.ranks), value, value, value};
    };
  };
  const auto add = [&](const std::string& codec, const std::string& title, const std::string& unit,
                       std::uint64_t composite::Counts::*amount) {
    charts.push_back(chart_over_ranks(rows, codec, title, unit, Source::counted, of(amount)));
  };
  for (const std::string& codec : codecs_of(rows)) {
    add(codec, "Bytes that all ranks send", "MB", &composite::Counts::bytes_total);
    add(codec, "Most bytes that a rank receives", "MB", &composite::Counts::bytes_received_max);
    add(codec, "Most pixels that a rank composites", "Mpixel",
        &composite::Counts::pixels_composited_max);
  }
  return in_columns(charts);
}

Html predictions(const CompareRequest& request, const ComposeComparison& comparison) {
  const std::vector<ComparedScheme>& rows = comparison.rows;
  std::vector<Html> charts;
  for (const std::string& network : networks_of(rows)) {
    for (const std::string& codec : codecs_of(rows)) {
      charts.push_back(chart_over_ranks(
          rows, codec, "Compositing over " + network, "time, ms", Source::predicted,
          [&](const ComparedScheme& row) -> std::optional<ChartPoint> {
            const Predicted* p = prediction(row, network);
            if (p == nullptr) return std::nullopt;
            const double ms = p->seconds * 1e3;
            return ChartPoint{static_cast<double>(row.ranks), ms, ms, ms};
          }));
    }
  }
  if (charts.empty()) {
    return paragraph(comparison.unfinished ? "Predictions had not begun."
                                           : "Nothing is predicted of these layers.");
  }
  return in_columns(charts) + omissions(comparison.left_out) +
         own_networks_tab(on_own_networks(rows, request.networks)) +
         growth_claims_tab(judge_growth(rows)) +
         paragraph(
             "Predicted: the schemes' own code runs on a simulated machine whose ranks "
             "have a core each. On this machine: by a model fitted to the times of the other "
             "half of the schemes, so that none is predicted from its own.");
}

constexpr const char* kActs[] = {"composite", "send", "wait and receive", "gather"};

Timeline timeline_of(const ShownScheme& shown) {
  Timeline result;
  result.title = "What each rank did";
  result.kinds.assign(std::begin(kActs), std::end(kActs));
  for (std::size_t rank = 0; rank < shown.ledger.ranks.size(); ++rank) {
    Lane lane{fmt::format("rank {}", rank), {}};
    double last = -1;
    for (const comm::Event& event : shown.ledger.ranks[rank]) {
      const bool gather = event.phase == comm::Phase::gather;
      // Between two calls the rank cuts and merges pixels.
      if (last >= 0 && event.begin > last)
        lane.spans.push_back({gather ? 3 : 0, last, event.begin, ""});
      if (event.end > event.begin) {
        const bool sends = event.kind == comm::Event::Kind::send;
        const bool message = sends || event.kind == comm::Event::Kind::receive;
        lane.spans.push_back(
            {gather  ? 3
             : sends ? 1
                     : 2,
             event.begin, event.end,
             message ? fmt::format("{} rank {}, {} bytes, round {}", sends ? "to" : "from",
                                   event.peer, event.amount, event.round)
                     : std::string()});
      }
      last = event.end;
    }
    result.lanes.push_back(std::move(lane));
  }
  return result;
}

// The bytes that ranks sent each other, in each round of compositing and in the gather.
std::vector<Html> byte_matrices(const ShownScheme& shown) {
  const int ranks = static_cast<int>(shown.ledger.ranks.size());
  std::map<std::pair<bool, int>, std::vector<double>> rounds;
  double most = 0;
  for (int rank = 0; rank < ranks; ++rank) {
    for (const comm::Event& event : shown.ledger.ranks[static_cast<std::size_t>(rank)]) {
      if (event.kind != comm::Event::Kind::send || event.peer == rank) continue;
      const bool gather = event.phase == comm::Phase::gather;
      if (!gather && event.phase != comm::Phase::compose) continue;
      std::vector<double>& sent = rounds[{gather, gather ? 0 : event.round}];
      sent.resize(static_cast<std::size_t>(ranks) * ranks);
      double& here = sent[static_cast<std::size_t>(rank) * ranks + event.peer];
      here += static_cast<double>(event.amount);
      most = std::max(most, here);
    }
  }
  std::vector<Html> result;
  for (auto& [key, sent] : rounds) {
    Matrix m;
    m.title = key.first ? "Gather" : fmt::format("Round {}", key.second);
    m.row_name = "from rank";
    m.column_name = "to rank";
    m.unit = "bytes";
    m.rows = m.columns = ranks;
    m.values = std::move(sent);
    result.push_back(matrix(m, most));
  }
  return result;
}

Html one_run(const ShownScheme& shown) {
  const std::size_t ranks = shown.ledger.ranks.size();
  Html result =
      paragraph(fmt::format("One run of {} with codec {} on {} ranks, as it was recorded: of {} "
                            "runs the one in the middle. Ranks that are blank have not had a core "
                            "yet or are done.",
                            shown.scheme, shown.codec, ranks, kShownRuns));
  result += picture(shown.picture, "The picture");
  result += heading("What each rank had drawn");
  std::vector<Html> partial, pieces;
  for (std::size_t k = 0; k < ranks; ++k) {
    partial.push_back(picture(shown.partial[k], fmt::format("rank {}", k)));
    pieces.push_back(picture(shown.pieces[k], fmt::format("rank {}", k)));
  }
  result += beside(partial) + heading("What each rank owned in the end") + beside(pieces);
  result += heading("Bytes between ranks") + beside(byte_matrices(shown));
  return result + timeline(timeline_of(shown));
}

Html all_rows(const CompareRequest& request, const std::vector<ComparedScheme>& rows) {
  const std::vector<std::vector<std::string>> text = compose_table(rows);
  Table result;
  for (std::size_t i = 0; i < text[0].size(); ++i) {
    const std::string& name = text[0][i];
    Column column{name, i != 1 && i != 2, i > 2, Source::counted};
    if (name.ends_with("predicted")) {
      column.source = Source::predicted;
      column.name = name.substr(0, name.find(','));
    } else if (name.ends_with(" ms")) {
      column.source = Source::measured;
    }
    result.columns.push_back(std::move(column));
  }
  result.rows.assign(text.begin() + 1, text.end());
  return table(result) +
         paragraph("MB sent and received and Mpixel max are of the rank that has most. Size " +
                   request.render.size + ".");
}

}  // namespace

std::string compose_report(const Session& session, const CompareRequest& request,
                           const Prepared& prepared, const ComposeComparison& comparison) {
  const std::vector<ComparedScheme>& rows = comparison.rows;
  Page result;
  const std::filesystem::path file(request.render.scene.file.path);
  result.title = fmt::format("Compositing {}, {}", file.filename().string(), request.render.size);
  result.unfinished = comparison.unfinished;
  result.machine = machine_and_compiler();
  result.answer = compose_answer(comparison);
  result.tabs.push_back({"Times", times(rows)});
  result.tabs.push_back({"Bytes", bytes(rows)});
  result.tabs.push_back({"Predictions", predictions(request, comparison)});
  if (comparison.shown) result.tabs.push_back({"One run", one_run(*comparison.shown)});
  result.tabs.push_back({"All figures", all_rows(request, rows)});
  result.data = compose_statistics(request, prepared, comparison);
  result.provenance = provenance(session, request.render.scene.file.path);
  return page(result);
}

}  // namespace delray::apps
