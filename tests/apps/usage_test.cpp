// Command lines that cannot be: one line that begins with "error: ", and what was probably meant.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

struct Mistake {
  std::string arguments;  // of delray
  std::string told;       // is part of the message
};

void expect_told(const std::string& command, const std::string& told, const Folder& folder) {
  const Ran ran = run(command, folder.path());
  EXPECT_EQ(ran.exit_code, 2) << command << "\n" << ran.err;
  EXPECT_EQ(ran.out, "") << command;
  EXPECT_EQ(ran.err.rfind("error: ", 0), 0U) << command << "\n" << ran.err;
  EXPECT_EQ(ran.err.find("error", 1), std::string::npos) << command << "\n" << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << command << "\n" << ran.err;
  EXPECT_NE(ran.err.find(told), std::string::npos) << command << "\n" << ran.err;
}

TEST(Usage, TellsWhatWasProbablyMeant) {
  const Folder folder;
  folder.write("p.xyz", "0 0\n1 0\n0 1\n");
  const std::string gen = "render gen:cornell -o a.png --size 8x8 ";
  for (const Mistake& mistake :
       {Mistake{"rendr a.obj", "'rendr' is not a command of delray; did you mean 'render'?"},
        {"rendr --help", "did you mean 'render'?"},
        {"compare compos a.obj", "command of delray compare; did you mean 'compose'?"},
        {"compare --quick compose", "'--quick' is not an option of delray compare"},
        {gen + "--ranks 2 --egnine raster", "did you mean '--engine'?"},
        {gen + "--egnine=raster", "'--egnine' is not an option of delray render;"},
        {gen + "-frames 2", "'-frames' is not an option of delray render; did you mean '--fra"},
        {gen + "--noi 0.1", "did you mean '--noise'?"},
        {gen + "--engine rastr", "--engine: 'rastr' is not one of raster, raytrace; did you m"},
        {gen + "--strategy sort-frist", "did you mean 'sort-first'?"},
        {gen + "--compose binary-swp", "did you mean 'binary-swap'?"},
        {gen + "--view tpo", "did you mean 'top'?"},
        {gen + "--background studoi", "did you mean 'studio'?"},
        {gen + "--color-by materail", "did you mean 'material'?"},
        {"render gen:cornel -o a.png", "did you mean 'cornell'?"},
        {"generate points unifrom -o a.ply", "did you mean 'uniform'?"},
        {"triangulate p.xyz -o a.ply --order brioo", "did you mean 'brio'?"},
        {"triangulate p.xyz -o a.ply --method optimstic", "did you mean 'optimistic'?"},
        {"completion bsh", "did you mean 'bash'?"}}) {
    expect_told("delray " + mistake.arguments, mistake.told, folder);
  }
}

TEST(Usage, DoesNotGuessWhereNothingIsNear) {
  const Folder folder;
  for (const Mistake& mistake :
       {Mistake{"bake", "'bake' is not a command of delray, which has info, generate, "},
        {"render gen:cornell -o a.png --nonsense 3",
         "'--nonsense' is not an option of delray render (delray render --help tells more)"},
        {"", "delray: a command is missing: info, generate, "},
        {"compare", "delray compare: a command is missing: compose, "}}) {
    expect_told("delray " + mistake.arguments, mistake.told, folder);
    const Ran ran = run("delray " + mistake.arguments, folder.path());
    EXPECT_EQ(ran.err.find("did you mean"), std::string::npos) << ran.err;
  }
}

// A value may look like an option or be that of a command.
TEST(Usage, TakesNoValueForAName) {
  const Folder folder;
  const std::string gen = "delray render gen:cornell --size 8x8 -o a.png ";
  const std::string camera = "--camera -5,1,2,0,0,0,0,1,0,40";
  expect_told(gen + camera + " --frames x", "--frames: ", folder);
  expect_told(gen + "--checkpoint --nonsense --frames x", "--frames: ", folder);
  expect_told("delray render -o compse --frames x", "--frames: ", folder);
  const Ran ran = run(gen + camera, folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
}

TEST(Usage, CountsMayBeWrittenShort) {
  const Folder folder;
  for (const std::string count : {"2000", "2e3", "2k", "2_000", "0.002M"}) {
    const Ran ran =
        run("delray generate points uniform -n " + count + " -o " + count + ".xyz", folder.path());
    ASSERT_EQ(ran.exit_code, 0) << count << ran.err;
    EXPECT_EQ(folder.read(count + ".xyz"), folder.read("2000.xyz")) << count;
  }
  const Ran ran =
      run("delray render gen:terrain:1e3 -o a.png --size 8x8 --ranks 1e0 --threads 0.1e1",
          folder.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(run("delray compare partition gen:terrain:1e3 --size 64x64 --quick --regions 0.1e1 "
                "--partition interlaced --ranks 2,0.4e1",
                folder.path())
                .exit_code,
            0);
}

TEST(Usage, CountsThatAreNoneAreRefused) {
  const Folder folder;
  const std::string points = "delray generate points uniform -o a.xyz -n ";
  expect_told(points + "2.5", "-n: '2.5' is not a whole number such as", folder);
  expect_told(points + "1e30", "-n: '1e30' is too large", folder);
  expect_told(points + "0", "-n: '0' is not from 1 to 4294967295", folder);
  expect_told(points + "-3", "-n: '-3' is not a whole number", folder);
  expect_told(points + "5 --seed 1.5", "--seed: '1.5' is not a whole number", folder);
  expect_told("delray generate scene city -o a.glb -n 1e10", "1000000000", folder);
  const std::string render = "delray render gen:cornell -o a.png --size 8x8 --engine raytrace ";
  expect_told(render + "--spp 1e5", "--spp: '1e5' is not from 1 to 65536", folder);
  expect_told("delray compare partition gen:cornell --ranks 2,0.5", "--ranks: '0.5'", folder);
  expect_told("delray render gen:city:1.5 -o a.png", "'1.5' is not a whole number", folder);
  EXPECT_TRUE(folder.files().empty());
}

TEST(Usage, EveryKindOfMistakeIsTheSameKindOfLine) {
  const Folder folder;
  const std::string gen = "delray render gen:cornell -o a.png --size 8x8 ";
  expect_told(gen + "b.glb c.glb", "only points are read from several files", folder);
  expect_told("delray generate points uniform -n 5 -o p.xyz b c", "unexpected arguments: b c (",
              folder);
  expect_told(gen + "--depth 1 --depth 2", "--depth: given more than once", folder);
  expect_told(gen + "--frames 0", "--frames: ", folder);
  expect_told(gen + "--camera", "--camera: a value is missing", folder);
  expect_told(gen + "--turntable 3 --frames 2", " has no effect with --", folder);
  expect_told("delray completion", "SHELL", folder);
  expect_told("delray completion bash zsh", "zsh", folder);
  expect_told("delray render", "SCENE", folder);
  expect_told("delray completion bash 'a\nb' c", "delray completion --help tells more", folder);
}

}  // namespace
}  // namespace delray::tests
