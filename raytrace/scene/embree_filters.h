// Functions that Embree calls back at hits, and the data that such a query carries.
#pragma once

#include "raytrace/scene/embree_objects.h"
#include "raytrace/scene/ray.h"

namespace delray::raytrace {

// Embree 4 passes flags and filters beside the context, Embree 3 within it.
#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
constexpr int kFilterOfQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using Context = RTCIntersectContext;
constexpr int kFilterOfQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

// The least of the hits that a ray was asked about.
struct Nearest {
  Hit hit;
  float normal_x, normal_y, normal_z;
  bool instanced;
};

// The query that filters belong to; element i is of the ray with id i.
struct Query {
  Context context;
  SeeThrough* passed = nullptr;
  Nearest* nearest = nullptr;
  const EmbreeScene::State* scene = nullptr;
};

// Filter of queries for nearest hits. Refuses every hit, so that Embree reports all, whatever their
// order, and keeps the least.
void find_least(const RTCFilterFunctionNArguments* arguments);

// Filter of shadow rays. Notes a hit and lets the ray go on, unless the triangle is opaque. Embree
// may report one hit several times.
void note_and_pass(const RTCFilterFunctionNArguments* arguments);

}  // namespace delray::raytrace
