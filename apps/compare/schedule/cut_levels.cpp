// A table by level. Degenerate: levels below which there is less than a triangle for each subtree
// give as many clusters as triangles.
#include "apps/compare/schedule/cut_levels.h"

#include <fmt/format.h>

#include "apps/report/page.h"
#include "apps/report/table.h"

namespace delray::apps {

report::Html cut_levels_tab(const std::vector<CutLevel>& levels) {
  using namespace report;
  if (levels.empty()) return "";
  Table text;
  text.columns = {{"level", true, false, {}},
                  {"subtrees", true, true, Source::counted},
                  {"replicated KiB", true, true, Source::counted},
                  {"geometry KiB, most of a rank", true, true, Source::counted},
                  {"rays sent", true, true, Source::counted},
                  {"MB sent", true, true, Source::counted},
                  {"rays intersected, max/mean", true, true, Source::counted},
                  {"frame ms", true, true, Source::predicted}};
  for (const CutLevel& one : levels) {
    const raytrace::SimulatedFrame& frame = one.frame;
    text.rows.push_back({std::to_string(one.level), std::to_string(frame.clusters),
                         fmt::format("{:.1f}", static_cast<double>(frame.tree_bytes) / 1024),
                         fmt::format("{:.0f}", static_cast<double>(frame.geometry_bytes) / 1024),
                         std::to_string(frame.rays_sent),
                         fmt::format("{:.3f}", static_cast<double>(frame.bytes) / 1e6),
                         fmt::format("{:.3f}", frame.test_imbalance),
                         milliseconds_text(frame.seconds, 3)});
  }
  return heading("Where the hierarchy is cut") +
         paragraph(fmt::format(
             "Caspary and Scherson (1989) give the subtrees below a cut to {} ranks, here over {}, "
             "and all ranks have what is above it. Cut high, there are few subtrees, and ranks "
             "have "
             "unequal shares; cut low, much is replicated.",
             levels.front().ranks, levels.front().network)) +
         table(text);
}

Json cut_levels_json(const std::vector<CutLevel>& levels) {
  Json rows = Json::array();
  for (const CutLevel& one : levels) {
    const raytrace::SimulatedFrame& frame = one.frame;
    rows.push_back({{"level", one.level},
                    {"ranks", one.ranks},
                    {"subtrees", frame.clusters},
                    {"replicated_bytes", frame.tree_bytes},
                    {"geometry_bytes_max", frame.geometry_bytes},
                    {"rays_sent", frame.rays_sent},
                    {"bytes_total", frame.bytes},
                    {"tests_imbalance", frame.test_imbalance},
                    {"network", one.network},
                    {"frame_seconds", frame.seconds}});
  }
  return rows;
}

}  // namespace delray::apps
