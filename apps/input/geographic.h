// Points whose x and y are longitude and latitude in degrees.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "delaunay/points.h"

namespace delray::apps {

// Metres on the ground of a degree of longitude (x) and of latitude (y) at a latitude in degrees.
glm::dvec2 metres_per_degree(double latitude);

// Whether the points are degrees: because their file says so, or because they lie within the
// degrees that there are and would be a needle fifty times as high as wide otherwise.
bool is_geographic(const delaunay::PointCloud& points);

// What x and y of points in degrees are to be multiplied by for metres, as they are at the points'
// middle latitude, and says so in the log; nothing for others.
std::optional<glm::dvec2> metres_of_degrees(const delaunay::PointCloud& points,
                                            const std::string& path);

// Scales x and y of points in degrees by metres_of_degrees; changes no others. Heights are taken
// for metres.
void to_metres(delaunay::PointCloud& points, const std::string& path);

}  // namespace delray::apps
