// How a surface scatters light in all directions: shading::reflect, completed by transmission and
// by a way to draw directions, for integrators that follow light from anywhere.
//
// Three lobes: the diffuse one and the specular one of shading/brdf.h, and light that passes a
// rough interface (Walter et al. 2007); a coat and a sheen lie over them where a surface has any.
// The share of a material that is glass reflects by Fresnel's equations, which know total
// reflection, the rest by Schlick's approximation. Below shading::kMinRoughness the interface is
// smooth: its reflection and refraction are deltas, which only `sample` finds. An interface between
// media of (nearly) the same density lets light straight through.
//
// Rays carry radiance over the square of the index of refraction, which refraction leaves as it is;
// so light on both sides of an interface counts alike.
//
// Sixteen surfaces at a time, by vectors chosen at run time: the same bits on every instruction
// set, whatever a surface's lane and whatever the others hold. Functions write the lanes in
// `lanes`; the others of their results are left or become anything.
#pragma once

#include "shading/batch.h"
#include "shading/points.h"

namespace delray::raytrace {

// Surfaces, each seen from one direction. Directions are unit vectors away from the surface.
struct Bsdfs {
  // Frames; z is the shading normal, turned, if need be, until the viewer is above it.
  shading::Vectors16 x, y, z;
  shading::Vectors16 geometric_normal;
  shading::Vectors16 view;         // in the frame; z > 0
  shading::Vectors16 diffuse;      // albedo times what enters, over pi
  shading::Vectors16 specular;     // reflectance at normal incidence
  shading::Vectors16 scale;        // of the specular lobe: Response::scale
  shading::Floats16 grazing;       // reflectance at grazing incidence
  shading::Floats16 alpha;         // GGX width
  shading::Vectors16 transmitted;  // glass times base colour: tints what passes
  shading::Floats16 glass;
  shading::Floats16 glass_scale;  // of what glass reflects and transmits, as scale is
  shading::Floats16 ratio;        // index of refraction on the viewer's side over that of the other
  shading::Floats16 diffuse_share;  // with which the diffuse lobe is drawn from; the rest: others

  shading::LaneMask smooth = 0;    // reflection, and refraction with it, has one direction only
  shading::LaneMask straight = 0;  // what passes does not change direction
  shading::LaneMask thin = 0;      // a pane: what passes is spread as if it were mirrored
  shading::LaneMask black = 0;     // nothing leaves in any direction
  shading::LaneMask layered = 0;   // the following are set
  shading::Layers layers[shading::kBlockPoints];
  shading::Vectors16 to_viewer;                  // in the world
  float coat_share[shading::kBlockPoints] = {};  // with which the coat is drawn from
};

// `views` are unit vectors to the viewers, for which `surfaces` were evaluated.
void make_bsdfs(const shading::Surfaces& surfaces, const shading::Vectors16& views,
                shading::LaneMask lanes, Bsdfs& bsdfs);

struct BsdfValues {
  shading::Vectors16 value;  // f(view, light) * |cos|: radiance to the viewer per unit of
                             // irradiance at normal incidence
  shading::Floats16 pdf;     // with which `sample` draws the direction, per steradian
};

// Without deltas. Zero for directions whose side of the geometric normal is not that of the shading
// normal: no light leaks through a closed mesh.
void evaluate(const Bsdfs& bsdfs, const shading::Vectors16& lights, shading::LaneMask lanes,
              BsdfValues& values);

struct BsdfSamples {
  shading::Vectors16 direction;       // to where light comes from
  shading::Vectors16 weight;          // f |cos| / pdf; zero: nothing comes of this sample
  shading::Floats16 pdf;              // as evaluate gives it; 0 for a delta
  shading::LaneMask transmitted = 0;  // to the other side of the surface
  shading::LaneMask diffuse = 0;      // drawn from the diffuse lobe
};

// `lobe`, `u` and `v` from [0, 1). The mean of `weight` is the albedo, at most about 1. Normals are
// drawn as the viewer sees them (Heitz 2018, by the spherical caps of Dupuy and Benyoub 2023).
void sample(const Bsdfs& bsdfs, const shading::Floats16& lobe, const shading::Floats16& u,
            const shading::Floats16& v, shading::LaneMask lanes, BsdfSamples& samples);

}  // namespace delray::raytrace
