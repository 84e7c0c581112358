// Turns the rows of a comparison of partitions into JSON and a table; rows that were not drawn have
// null or a dash for what only frames tell.
#include "apps/compare/partition/partition_figures.h"

#include <fmt/format.h>

#include "apps/compare/partition/scaling_figures.h"
#include "comm/network.h"

namespace delray::apps {
namespace {

Json frames_of(const DrawnFrames& drawn, int ranks) {
  Json result = Json::array();
  for (const PredictedFrame& one : drawn.predicted) {
    result.push_back({{"network", one.network},
                      {"ranks", ranks},
                      {"seconds", one.seconds},
                      {"spread", spread_json(one.spread)},
                      {"first_seconds", one.first_seconds}});
  }
  return result;
}

void add_counts(const DrawnFrames& drawn, Json& row) {
  row["bytes_total"] = drawn.bytes_total;
  row["bytes_next_frame"] = drawn.bytes_next;
  row["messages"] = drawn.messages;
  row["triangles_total"] = drawn.triangles_total;
  row["triangles_max"] = drawn.triangles_max;
  row["samples_shaded_max"] = drawn.shaded_max;
  row["work_imbalance"] = drawn.work_imbalance;
  row["work_over_share"] = drawn.work_over_share;
}

Json row_of(const ComparedPartition& row) {
  Json one = {{"partition", row.partition},
              {"ranks", row.ranks},
              {"regions_per_rank", row.regions_per_rank},
              {"regions", row.regions},
              {"primitives", row.primitives},
              {"primitives_shared", row.shared},
              {"overlap", row.overlap}};
  if (row.drawn) add_counts(*row.drawn, one);
  one["seconds"] = {{"cut", row.cut_seconds.median},
                    {"busiest", row.drawn ? Json(row.drawn->busiest.median) : Json(nullptr)}};
  one["spread"] = {{"cut", spread_json(row.cut_seconds)},
                   {"busiest", row.drawn ? spread_json(row.drawn->busiest) : Json(nullptr)}};
  one["imbalance"] = row.drawn ? Json(row.drawn->imbalance.median) : Json(nullptr);
  one["predicted_imbalance"] = row.predicted_imbalance;
  one["predicted_over_share"] = row.predicted_over_share;
  one["predicted_finish_seconds"] = row.drawn ? Json(row.finish_seconds) : Json(nullptr);
  one["predicted"] = row.drawn ? frames_of(*row.drawn, row.ranks) : Json::array();
  one["image_hash"] = row.drawn ? Json(row.drawn->hash) : Json(nullptr);
  if (row.to_displays) {
    one["to_displays"] = {{"pixels", row.to_displays->pixels},
                          {"pixels_busiest", row.to_displays->busiest}};
  }
  return one;
}

Json walls_json(const PartitionRequest& request, const std::vector<ComparedWall>& walls) {
  if (!request.render.layout.wall) return nullptr;
  const loadbalance::Wall& wall = *request.render.layout.wall;
  Json rows = Json::array();
  for (const ComparedWall& row : walls) {
    rows.push_back({{"ranks", row.ranks},
                    {"gathered_pixels_busiest", row.gathered},
                    {"at_home",
                     {{"pixels", 0},
                      {"predicted_over_share", row.predicted_over_share},
                      {"overlap", row.overlap}}}});
  }
  return {{"columns", wall.columns},
          {"rows", wall.rows},
          {"bezel", {wall.bezel_x, wall.bezel_y}},
          {"by_ranks", rows}};
}

Json row_of(const ComparedStrategy& row) {
  Json one = {{"strategy", row.strategy}, {"ranks", row.ranks}};
  add_counts(row.drawn, one);
  one["seconds"] = {{"busiest", row.drawn.busiest.median}};
  one["spread"] = {{"busiest", spread_json(row.drawn.busiest)}};
  one["imbalance"] = row.drawn.imbalance.median;
  one["predicted"] = frames_of(row.drawn, row.ranks);
  one["image_hash"] = row.drawn.hash;
  return one;
}

}  // namespace

Json partition_statistics(const PartitionRequest& request, const Prepared& prepared,
                          const PartitionComparison& comparison) {
  Json rows = Json::array(), strategies = Json::array();
  for (const ComparedPartition& row : comparison.rows) rows.push_back(row_of(row));
  for (const ComparedStrategy& row : comparison.strategies) strategies.push_back(row_of(row));
  return {{"schema", "delray.compare.partition/1"},
          {"scene", scene_json(request, prepared)},
          {"options",
           {{"size", request.render.size},
            {"ranks", request.ranks},
            {"regions", request.regions},
            {"quick", request.quick}}},
          {"unfinished", comparison.unfinished},
          {"networks", networks_json(request.networks)},
          {"alone", {{"work", comparison.alone_work}, {"seconds", comparison.alone_seconds}}},
          {"rows", std::move(rows)},
          {"strategies", std::move(strategies)},
          {"wall", walls_json(request, comparison.walls)},
          {"scaling", scaling_json(comparison.scaling)}};
}

TextTable partition_table(const std::vector<ComparedPartition>& rows) {
  TextTable table = {{"ranks", "regions", "partition", "primitives", "shared", "overlap",
                      "triangles max", "samples max", "work max/mean", "work over share",
                      "MB first", "MB next", "cut ms", "cut from..to ms", "busiest ms",
                      "busiest from..to ms", "time max/mean", "max/mean, predicted",
                      "over share, predicted"}};
  const bool has_wall = !rows.empty() && rows.front().to_displays;
  if (has_wall)
    table.front().insert(table.front().end(), {"pixels to displays", "of the busiest rank"});
  for (const ComparedPartition& row : rows) {
    const auto of = [&](auto&& text) { return row.drawn ? text(*row.drawn) : std::string("-"); };
    const auto megabytes = [](std::uint64_t bytes) {
      return fmt::format("{:.3f}", static_cast<double>(bytes) / 1e6);
    };
    table.push_back(
        {std::to_string(row.ranks), std::to_string(row.regions), row.partition,
         std::to_string(row.primitives), std::to_string(row.shared), ratio_text(row.overlap),
         of([](const DrawnFrames& d) { return std::to_string(d.triangles_max); }),
         of([](const DrawnFrames& d) { return std::to_string(d.shaded_max); }),
         of([](const DrawnFrames& d) { return ratio_text(d.work_imbalance); }),
         of([](const DrawnFrames& d) { return ratio_text(d.work_over_share); }),
         of([&](const DrawnFrames& d) { return megabytes(d.bytes_total); }),
         of([&](const DrawnFrames& d) { return megabytes(d.bytes_next); }),
         milliseconds_text(row.cut_seconds.median, 3), range_text(row.cut_seconds),
         of([](const DrawnFrames& d) { return milliseconds_text(d.busiest.median, 3); }),
         of([](const DrawnFrames& d) { return range_text(d.busiest); }),
         of([](const DrawnFrames& d) { return ratio_text(d.imbalance.median); }),
         ratio_text(row.predicted_imbalance), ratio_text(row.predicted_over_share)});
    if (!has_wall) continue;
    table.back().push_back(std::to_string(row.to_displays->pixels));
    table.back().push_back(std::to_string(row.to_displays->busiest));
  }
  return table;
}

}  // namespace delray::apps
