// Builds the JSON of a rendering from either engine's statistics by overloads; fields that only the
// other engine has are 0 or null.
#include "apps/render/render_statistics.h"

#include <algorithm>

namespace delray::apps {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

Json options_of(const RenderRequest& request, int ranks, int threads) {
  Json options = chosen_options(request);
  options["light"] = request.light.light;
  options["light_rotation"] = request.light.rotation;
  options["light_strength"] = request.light.strength;
  options["camera"] = request.camera.camera;
  options["view"] = request.camera.view;
  options["clip"] = request.camera.clip;
  options["color_by"] = request.scene.colour_by;
  options["up"] = request.scene.up;
  options["ranks"] = ranks;
  options["threads"] = threads;
  return options;
}

Json phases_of(const raster::Statistics& s) {
  const raster::Phases& p = s.phases;
  return {{"transform", p.transform}, {"bin", p.bin},
          {"rasterize", p.rasterize}, {"trace", 0},
          {"shade", p.shade},         {"redistribute", p.redistribute},
          {"compose", p.compose},     {"gather", p.gather}};
}

Json phases_of(const raytrace::Statistics& s) {
  return {{"transform", 0}, {"bin", 0},          {"rasterize", 0}, {"trace", s.trace_seconds},
          {"shade", 0},     {"redistribute", 0}, {"compose", 0},   {"gather", s.gather_seconds}};
}

// Counts that only the rasterizer has.
Json raster_of(const raster::Statistics& s) {
  Json counts = {{"triangles",
                  {{"in", s.triangles_in},
                   {"culled", s.triangles_culled},
                   {"clipped", s.triangles_clipped},
                   {"hidden", s.triangles_hidden},
                   {"rasterized", s.triangles_rasterized},
                   {"travelled", s.triangles_travelled}}},
                 {"fragments", s.fragments},
                 {"shaded", s.shaded}};
  if (s.partition) {
    counts["partition"] = {{"predicted_imbalance", s.partition->predicted},
                           {"over_share", s.partition->over_share},
                           {"overlap", s.partition->overlap},
                           {"seconds", s.partition->seconds},
                           {"kept", s.partition->kept}};
  }
  return counts;
}
Json raster_of(const raytrace::Statistics&) { return nullptr; }

Json json_of(const raster::PackCounts& pack) {
  Json levels = Json::array();
  for (const std::uint64_t triangles : pack.levels) levels.push_back(triangles);
  while (levels.size() > 1 && levels.back() == 0) levels.erase(levels.size() - 1);
  return {{"pages", pack.pages},
          {"pages_hidden", pack.pages_hidden},
          {"clusters", pack.clusters},
          {"levels", levels},
          {"pages_read", pack.cache.pages_read},
          {"bytes_read", pack.cache.bytes_read},
          {"hits", pack.cache.hits},
          {"misses", pack.cache.misses},
          {"stalls", pack.cache.stalls},
          {"stall_seconds", pack.cache.stall_seconds}};
}
Json pack_of(const raster::Statistics& s) { return s.pack ? json_of(*s.pack) : Json(nullptr); }
Json pack_of(const raytrace::Statistics&) { return nullptr; }

raytrace::RayCounts rays_of(const raster::Statistics&) { return {}; }
raytrace::RayCounts rays_of(const raytrace::Statistics& s) { return s.rays; }

Json embree_of(const raster::Statistics&) { return {{"version", nullptr}, {"isa", nullptr}}; }
Json embree_of(const raytrace::Statistics& s) {
  return {{"version", s.embree_version}, {"isa", s.embree_isa}};
}

// Counts that only the ray tracer has.
Json raytrace_of(const raytrace::Statistics& s) {
  Json counts = {{"imbalance_rays", s.imbalance_rays},
                 {"structure_bytes", s.structure_bytes},
                 {"degenerate", s.degenerate}};
  if (!s.why_traced.empty()) counts["why_traced"] = s.why_traced;
  if (s.partition) {
    counts["partition"] = {{"predicted_imbalance", s.partition->predicted},
                           {"measured", s.partition->measured},
                           {"kept", s.partition->kept}};
  }
  return counts;
}
Json raytrace_of(const raster::Statistics&) { return nullptr; }

Json of_rays(const raytrace::RayCounts& rays) {
  return {{"primary", rays.primary},
          {"shadow", rays.shadow},
          {"secondary", rays.secondary},
          {"surplus", rays.surplus},
          {"rasterized", rays.rasterized}};
}

// Adds the counts that ranks of only one engine have.
void add_own(const raster::RankStatistics& rank, Json& row) {
  row["tasks_stolen"] = rank.blocks_stolen;
  if (rank.pack.pages > 0) row["pack"] = json_of(rank.pack);
}
void add_own(const raytrace::RankStatistics& rank, Json& row) {
  constexpr const char* kKinds[] = {"work", "serve", "wait"};
  row["tasks_stolen"] = rank.tasks_stolen;
  row["rays_stolen"] = rank.rays_stolen;
  row["rays"] = of_rays(rank.rays);
  row["data"] = {{"rays_sent", rank.rays_sent},
                 {"answers_sent", rank.answers_sent},
                 {"tests", rank.tests},
                 {"clusters_fetched", rank.clusters_fetched},
                 {"clusters_fetched_bytes", rank.clusters_fetched_bytes},
                 {"clusters_dropped", rank.clusters_dropped},
                 {"clusters_moved", rank.clusters_moved},
                 {"geometry_bytes", rank.geometry_bytes},
                 {"clusters", rank.clusters},
                 {"tree_bytes", rank.tree_bytes}};
  Json& timeline = row["timeline"] = Json::array();
  for (const loadbalance::Interval& interval : rank.timeline) {
    timeline.push_back({{"thread", interval.thread},
                        {"kind", kKinds[static_cast<std::size_t>(interval.kind)]},
                        {"tasks", interval.tasks},
                        {"begin", interval.begin},
                        {"end", interval.end}});
  }
}

// In-process ranks share the memory of the process: each is told its peak.
template <class Ranks>
Json ranks_of(const Ranks& ranks, const std::vector<std::uint64_t>& peak_rss) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    rows.push_back({{"rank", i},
                    {"busy", ranks[i].busy},
                    {"tasks", ranks[i].tasks},
                    {"requests", ranks[i].requests},
                    {"steals", ranks[i].steals},
                    {"idle", ranks[i].idle},
                    {"bytes_sent", ranks[i].bytes_sent},
                    {"bytes_received", ranks[i].bytes_received},
                    {"messages", ranks[i].messages},
                    {"peak_rss", peak_rss[i]}});
    add_own(ranks[i], rows.back());
  }
  return rows;
}

template <class Ranks>
double imbalance_of(const Ranks& ranks) {
  double sum = 0, most = 0;
  for (const auto& rank : ranks) {
    sum += rank.busy;
    most = std::max(most, rank.busy);
  }
  return sum > 0 ? most * static_cast<double>(ranks.size()) / sum : 1.0;
}

Json json_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// As --camera takes it, unless it is orthographic: its height tells that.
Json json_of(const scenes::Camera& camera, const glm::dvec3& origin) {
  Json json = {{"eye", json_of(glm::dvec3(camera.eye) + origin)},
               {"at", json_of(glm::dvec3(camera.at) + origin)},
               {"up", json_of(camera.up)},
               {"fov", camera.vertical_fov}};
  if (camera.orthographic()) json["height"] = camera.height;
  if (!camera.name.empty()) json["name"] = camera.name;
  return json;
}

}  // namespace

Json render_statistics(const RenderRequest& request, const Prepared& prepared, const Frames& frames,
                       const std::string& hash, double write_seconds) {
  return std::visit(
      [&](const auto& s) -> Json {
        return {
            {"schema", "delray.render/1"},
            {"scene",
             {{"file", request.scene.file.path},
              {"triangles", prepared.triangles},
              {"points", prepared.points},
              {"vertices", prepared.vertices},
              {"instances", prepared.part ? 1 : prepared.scene.instances.size()},
              {"parts", prepared.part ? s.ranks.size() : 1}}},
            {"camera", json_of(prepared.camera, prepared.scene.origin)},
            {"options",
             options_of(request, static_cast<int>(s.ranks.size()), frames.launched.threads)},
            {"image",
             {{"width", request.picture_width()},
              {"height", request.picture_height()},
              {"hash", hash}}},
            {"seconds",
             {{"load", prepared.load_seconds + frames.launched.load_seconds},
              {"build", prepared.build_seconds + frames.launched.build_seconds},
              {"frame", median(frames.seconds)},
              {"frame_min", *std::min_element(frames.seconds.begin(), frames.seconds.end())},
              {"write", write_seconds}}},
            {"embree", embree_of(s)},
            {"phases", phases_of(s)},
            {"rays", of_rays(rays_of(s))},
            {"raster", raster_of(s)},
            {"raytrace", raytrace_of(s)},
            {"pack", pack_of(s)},
            {"sampling",
             {{"passes", frames.extras.passes},
              {"samples", frames.extras.samples},
              {"out_of_time", frames.extras.out_of_time},
              {"noisy", frames.extras.noisy}}},
            {"imbalance", imbalance_of(s.ranks)},
            {"ranks", ranks_of(s.ranks, frames.launched.peak_rss)},
        };
      },
      frames.statistics);
}

Json animation_statistics(const Animation& animation) {
  Json stages = Json::array();
  for (std::size_t i = 0; i < animation.stages.size(); ++i) {
    stages.push_back({{"name", animation.stages[i]},
                      {"seconds", animation.all.stages[i]},
                      {"seconds_alone", animation.alone.stages[i]}});
  }
  Json motion = Json::array();
  for (const FrameMotion& frame : animation.motion) {
    motion.push_back({{"seconds", frame.seconds},
                      {"instances", frame.instances},
                      {"meshes", frame.meshes},
                      {"pose_seconds", frame.pose_seconds},
                      {"top_seconds", frame.follow.top_seconds},
                      {"refitted", frame.follow.refitted},
                      {"refit_seconds", frame.follow.refit_seconds},
                      {"built", frame.follow.built},
                      {"build_seconds", frame.follow.build_seconds},
                      {"frame_seconds", frame.frame_seconds},
                      {"bytes_sent", frame.bytes},
                      {"triangles_sent", frame.triangles}});
  }
  Json statistics = {
      {"motion", motion},
      {"rays", of_rays(animation.rays)},
      {"frames", animation.frames.seconds.size()},
      {"frames_at_once", animation.slots},
      {"stages", stages},
      {"seconds", animation.all.seconds},
      {"overlapped", {{"frames", animation.overlapped}, {"seconds", animation.overlapped_seconds}}},
      {"sequential_seconds", animation.sequential_seconds()},
      {"predicted_seconds", animation.predicted_seconds()},
      {"speed_up", animation.speed_up()},
      {"predicted_speed_up", animation.predicted_speed_up()}};
  if (!animation.errors.empty()) {
    Json& rows = statistics["each"] = Json::array();
    for (std::size_t i = 0; i < animation.errors.size(); ++i) {
      rows.push_back({{"seconds", animation.frames.seconds[i]},
                      {"error", animation.errors[i]},
                      {"triangles", animation.triangles[i]}});
    }
  }
  return statistics;
}

}  // namespace delray::apps
