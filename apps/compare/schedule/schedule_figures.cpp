// Turns the rows of a comparison of schedules, and the cost of every tile, into JSON and a table.
#include "apps/compare/schedule/schedule_figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/compare/schedule/cut_levels.h"

namespace delray::apps {
namespace {

Json parts_json(const ScheduleOver& over) {
  Json parts;
  for (std::size_t i = 0; i < over.parts.size(); ++i) parts[kScheduleParts[i]] = over.parts[i];
  return parts;
}

std::vector<std::string> schedules_of(const ScheduleComparison& comparison) {
  std::vector<std::string> names;
  for (const ComparedSchedule& row : comparison.rows)
    if (std::find(names.begin(), names.end(), row.schedule) == names.end())
      names.push_back(row.schedule);
  return names;
}

// `alone`: seconds of one rank.
Json row_of(const ComparedSchedule& row, double alone) {
  const ScheduleOver& counted = row.over.front();
  Json one = {{"schedule", row.schedule},
              {"ranks", row.ranks},
              {"requests", counted.requests},
              {"steals", counted.steals},
              {"tasks_stolen", counted.tasks_stolen},
              {"rays_stolen", counted.rays_stolen},
              {"messages", counted.messages},
              {"bytes_total", counted.bytes},
              {"imbalance_rays", counted.ray_imbalance}};
  one["traced"] = row.traced ? Json({{"requests", row.traced->requests},
                                     {"steals", row.traced->steals},
                                     {"rays_stolen", row.traced->rays_stolen},
                                     {"messages", row.traced->messages},
                                     {"imbalance_rays", row.traced->ray_imbalance}})
                             : Json(nullptr);
  one["seconds"] = {{"frame", row.traced ? Json(row.traced->seconds.median) : Json(nullptr)}};
  one["spread"] = {{"frame", row.traced ? spread_json(row.traced->seconds) : Json(nullptr)}};
  one["predicted"] = Json::array();
  for (const ScheduleOver& over : row.over) {
    one["predicted"].push_back(
        {{"network", over.network},
         {"ranks", row.ranks},
         {"seconds", over.seconds},
         {"spread", spread_json(over.spread)},
         {"frame_seconds", over.frame_seconds},
         {"speed_up", alone / over.frame_seconds},
         {"efficiency", alone / over.frame_seconds / row.ranks},
         {"serial_fraction", serial_fraction_json(alone / over.frame_seconds, row.ranks)},
         {"busiest_rank_seconds", parts_json(over)},
         {"imbalance", over.time_imbalance},
         {"idle", over.idle},
         {"imbalance_rays", over.ray_imbalance},
         {"requests", over.requests},
         {"steals", over.steals},
         {"rays_stolen", over.rays_stolen},
         {"messages", over.messages}});
  }
  one["image_hash"] = row.traced ? Json(row.traced->hash) : Json(nullptr);
  return one;
}

Json distributions_json(const ScheduleComparison& comparison) {
  Json rows = Json::array();
  for (const ComparedDistribution& row : comparison.distributions) {
    Json one = {{"distribution", row.distribution}, {"ranks", row.ranks}};
    one["predicted"] = Json::array();
    for (const ComparedDistribution::Over& over : row.over) {
      Json parts;
      for (std::size_t i = 0; i < over.frame.parts.size(); ++i)
        parts[kScheduleParts[i]] = over.frame.parts[i];
      const double speed_up = comparison.seconds / over.frame.seconds;
      one["predicted"].push_back({{"network", over.network},
                                  {"frame_seconds", over.frame.seconds},
                                  {"speed_up", speed_up},
                                  {"efficiency", speed_up / row.ranks},
                                  {"serial_fraction", serial_fraction_json(speed_up, row.ranks)},
                                  {"busiest_rank_seconds", std::move(parts)},
                                  {"bytes_total", over.frame.bytes},
                                  {"messages", over.frame.messages},
                                  {"rays_sent", over.frame.rays_sent}});
    }
    rows.push_back(std::move(one));
  }
  return rows;
}

}  // namespace

Json schedule_statistics(const ScheduleRequest& request, const Prepared& prepared,
                         const ScheduleComparison& comparison) {
  Json rows = Json::array(), tiles = Json::array();
  for (const ComparedSchedule& row : comparison.rows)
    rows.push_back(row_of(row, comparison.seconds));
  Json limits = Json::array();
  for (const std::string& schedule : schedules_of(comparison)) {
    for (std::size_t i = 0; i < comparison.rows.front().over.size(); ++i) {
      Json limit = limit_json(limit_of(comparison, schedule, i), kScheduleParts);
      Json one = {{"schedule", schedule}, {"network", comparison.rows.front().over[i].network}};
      one.update(limit);
      limits.push_back(std::move(one));
    }
  }
  for (const Tile& tile : comparison.tiles)
    tiles.push_back({tile.pixels.x0, tile.pixels.y0, tile.rays, tile.seconds.median});
  return {{"schema", "delray.compare.schedule/1"},
          {"scene", scene_json(request, prepared)},
          {"options",
           {{"size", request.render.size},
            {"ranks", request.ranks},
            {"integrator", request.render.raytrace.integrator},
            {"spp", request.render.raytrace.samples},
            {"depth", request.render.raytrace.trace.depth},
            {"tile", request.tile},
            {"network", request.networks.front().name},
            {"quick", request.quick}}},
          {"unfinished", comparison.unfinished},
          {"networks", networks_json(request.networks)},
          {"alone", {{"rays", comparison.rays}, {"seconds", comparison.seconds}}},
          {"rows", std::move(rows)},
          {"stops_gaining", std::move(limits)},
          {"distributions", distributions_json(comparison)},
          {"cut_levels", cut_levels_json(comparison.cut_levels)},
          {"tile_columns", {"x", "y", "rays", "seconds"}},
          {"tiles", std::move(tiles)}};
}

TextTable schedule_table(const ScheduleComparison& comparison) {
  std::vector<std::string> head = {"ranks",       "schedule",         "requests", "steals",
                                   "rays stolen", "messages",         "KiB",      "rays max/mean",
                                   "frame ms",    "frame from..to ms"};
  for (const ScheduleOver& over : comparison.rows.front().over)
    head.push_back(over.network + " ms, predicted");
  TextTable table = {std::move(head)};
  for (const ComparedSchedule& row : comparison.rows) {
    const ScheduleOver& counted = row.over.front();
    std::vector<std::string> line = {
        std::to_string(row.ranks),
        row.schedule,
        std::to_string(counted.requests),
        std::to_string(counted.steals),
        std::to_string(counted.rays_stolen),
        std::to_string(counted.messages),
        fmt::format("{:.1f}", static_cast<double>(counted.bytes) / 1024),
        ratio_text(counted.ray_imbalance),
        row.traced ? milliseconds_text(row.traced->seconds.median, 3) : "-",
        row.traced ? range_text(row.traced->seconds) : "-"};
    for (const ScheduleOver& over : row.over) line.push_back(milliseconds_text(over.seconds, 3));
    table.push_back(std::move(line));
  }
  return table;
}

}  // namespace delray::apps
