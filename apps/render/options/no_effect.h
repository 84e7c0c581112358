// Why options of `delray render` have no effect, and when they are reported.
#pragma once

#include <functional>
#include <string>

#include "apps/render/options/render_options.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"
#include "raytrace/integrator.h"

namespace delray::apps {

inline const raster::Strategy& strategy_of(const RenderRequest& request) {
  return *raster::find_strategy(request.raster.strategy);
}
inline const raytrace::Integrator& integrator_of(const RenderRequest& request) {
  return raytrace::integrator(request.raytrace.integrator);
}
// Null: none, as the rasterizer has by default.
inline const loadbalance::Schedule* schedule_of(const RenderRequest& request) {
  return loadbalance::find_schedule(request.sharing.schedule);
}

inline bool is_raster(const RenderRequest& request) { return request.engine == Engine::raster; }

// Whether the rasterizer runs with a strategy that has a capability.
using Capability = bool raster::Strategy::*;
inline std::function<bool(const RenderRequest&)> strategy_that(Capability can) {
  return [can](const RenderRequest& r) { return is_raster(r) && strategy_of(r).*can; };
}
// Or the ray tracer.
inline std::function<bool(const RenderRequest&)> ray_tracer_or_strategy_that(Capability can) {
  return [can](const RenderRequest& r) { return is_raytrace(r) || strategy_of(r).*can; };
}

// Why an option has no effect: where it is the other engine's, where the rasterizer's strategy
// lacks a capability, and for reasons of its own; empty where it has one.
using Why = std::function<std::string(const RenderRequest&)>;
inline Why unless_raster(Why why = {}) {
  return [why](const RenderRequest& r) -> std::string {
    if (!is_raster(r)) return "--engine raytrace";
    return why ? why(r) : "";
  };
}
inline Why unless_raytrace(Why why = {}) {
  return [why](const RenderRequest& r) -> std::string {
    if (!is_raytrace(r)) return "--engine raster";
    return why ? why(r) : "";
  };
}
inline Why unless_strategy(Capability can, Why why = {}) {
  return [can, why](const RenderRequest& r) -> std::string {
    if (is_raster(r) && !(strategy_of(r).*can)) return "--strategy " + r.raster.strategy;
    return why ? why(r) : "";
  };
}
inline Why unless_integrator(bool raytrace::Integrator::*can) {
  return unless_raytrace([can](const RenderRequest& r) -> std::string {
    return integrator_of(r).*can ? "" : "--integrator " + r.raytrace.integrator;
  });
}

}  // namespace delray::apps
