// Which instruction sets shading is compiled for. To be included before any header of Highway.
#pragma once

// Vectors of a length that the compiler does not know cannot be members of structures. Machines
// that have them have NEON too.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE_256 | HWY_SVE2 | HWY_SVE2_128)
