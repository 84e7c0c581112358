// The part that rough glass leaves of light that meets it once.
#pragma once

namespace delray::raytrace {

// The fraction of light from everywhere, on both sides, that an interface without tint reflects and
// transmits to a viewer at a cosine, both by Fresnel's equations and with Smith's shadowing; the
// rest is lost between microscopic normals. `ratio` is the index of refraction on the viewer's side
// over that of the other; beyond 1/3 to 3 it counts as there. Within 0.01, by a table of
// which calls compute what is missing, in some 10 ms each.
float glass_albedo(float ratio, float roughness, float cosine);

// Of a pane of no thickness, which spreads what passes as if it were mirrored: of any index.
float pane_albedo(float roughness, float cosine);

}  // namespace delray::raytrace
