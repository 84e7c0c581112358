// Small stacks, as batch systems and containers may set them (ulimit -s), are no reason to fail.
#include <gtest/gtest.h>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

TEST(SmallStacks, AreEnough) {
  const Folder folder;
  ASSERT_EQ(run("delray generate points uniform -n 5000 --dim 3 -o p.xyz", folder.path()).exit_code,
            0);
  const std::string render = "delray render gen:spheres:3000 --size 96x64 -o a.exr ";
  for (const std::string& command :
       {render + "--threads 3", render + "--ranks 3 --strategy sort-middle --samples 4",
        render + "--engine raytrace --threads 3",
        render + "--engine raytrace --integrator path --spp 4 --denoise",
        render + "--engine raytrace --integrator path --data ray --ranks 3",
        std::string("delray triangulate p.xyz --dim 3 --threads 3 -o m.vtu"),
        std::string("delray triangulate p.xyz --method optimistic --threads 3 -o m.ply"),
        std::string("delray compare compose gen:spheres:500 --size 64x48 --ranks 2,256 --quick")}) {
    for (const std::string kibibytes : {"512", "192"}) {
      const Ran ran = run("ulimit -s " + kibibytes + "; " + command, folder.path());
      EXPECT_EQ(ran.exit_code, 0) << kibibytes << ": " << command << "\n" << ran.err;
    }
  }
}

}  // namespace
}  // namespace delray::tests
