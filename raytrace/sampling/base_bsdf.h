// Bsdfs without the layers on top of them.
#pragma once

#include "raytrace/sampling/bsdf.h"

namespace delray::raytrace {

// As the functions of bsdf.h. The first returns the lanes with glass that is neither smooth nor
// lets light straight through, for which glass_scale, now 1, is to be set.
shading::LaneMask make_base_bsdfs(const shading::Surfaces& surfaces,
                                  const shading::Vectors16& views, shading::LaneMask lanes,
                                  Bsdfs& bsdfs);
void evaluate_base(const Bsdfs& bsdfs, const shading::Vectors16& lights, shading::LaneMask lanes,
                   BsdfValues& values);
void sample_base(const Bsdfs& bsdfs, const shading::Floats16& lobe, const shading::Floats16& u,
                 const shading::Floats16& v, shading::LaneMask lanes, BsdfSamples& samples);

}  // namespace delray::raytrace
