// What a user of rays does in practice, with the built program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/io.h"
#include "tests/support/run_program.h"

namespace delray::tests {
namespace {

using nlohmann::json;

const std::string kRays = "delray render gen:spheres:2000 --engine raytrace -q ";
const std::string kSmall = " --engine raytrace --size 80x60 -q ";
const std::string kBall = kRays + "--size 80x60 ";

json stats_of(const std::string& options, const Folder& folder, const std::string& what = kBall) {
  const Ran ran = run(what + options + " --stats stats.json", folder.path());
  EXPECT_EQ(ran.exit_code, 0) << options << "\n" << ran.err;
  return ran.exit_code == 0 ? json::parse(folder.read("stats.json")) : json();
}

TEST(Practice, AnInterruptedPictureGoesOnToTheSameBytes) {
  const Folder folder;
  const std::string picture = "--integrator path --spp 48 -o a.exr ";
  const json whole = stats_of(picture, folder);
  // Ctrl-C as soon as there is something to keep.
  const Ran stopped = run(kBall + picture +
                              "--checkpoint a.film --checkpoint-every 0 & p=$!; "
                              "while [ ! -e a.film ]; do sleep 0.01; done; kill -INT $p; wait $p",
                          folder.path());
  EXPECT_TRUE(stopped.exit_code == 130 || stopped.exit_code == 0) << stopped.err;
  const json resumed = stats_of(picture + "--checkpoint a.film --resume --ranks 2", folder);
  EXPECT_EQ(resumed["image"]["hash"], whole["image"]["hash"]);
  EXPECT_EQ(resumed["sampling"]["samples"], 48);
  // Once more: nothing is left to do.
  const json again = stats_of(picture + "--checkpoint a.film --resume", folder);
  EXPECT_EQ(again["image"]["hash"], whole["image"]["hash"]);
  EXPECT_EQ(again["sampling"]["passes"], 0);
  EXPECT_EQ(
      run(kBall + picture + "--checkpoint a.film --resume --depth 2", folder.path()).exit_code, 3);
  EXPECT_EQ(run(kBall + picture + "--checkpoint none.film --resume", folder.path()).exit_code, 3);
}

// A sample does not depend on how many there are, nor on when they are asked for.
TEST(Practice, APictureGoesOnToMoreSamplesThanItWasBegunFor) {
  for (const std::string options :
       {"--integrator path ", "--integrator ao ", "--integrator path --ranks 2 --data ray ",
        "--integrator whitted --noise 0.003 ", "--integrator path --noise 0.02 "}) {
    SCOPED_TRACE(options);
    const Folder folder;
    const std::string picture = options + "-o a.exr ";
    const std::string tiny = kRays + "--size 40x30 ";
    const json whole = stats_of(picture + "--spp 44", folder, tiny);
    const json begun = stats_of(picture + "--spp 16 --checkpoint a.film", folder, tiny);
    EXPECT_NE(begun["image"]["hash"], whole["image"]["hash"]);
    const json more = stats_of(picture + "--spp 44 --checkpoint a.film --resume", folder, tiny);
    EXPECT_EQ(more["image"]["hash"], whole["image"]["hash"]);
    EXPECT_EQ(more["sampling"]["samples"], whole["sampling"]["samples"]);
  }
}

TEST(Practice, WhatCannotGoOnSaysWhatDiffers) {
  const Folder folder;
  const auto why = [&](const std::string& first, const std::string& then) {
    std::filesystem::remove(folder / "a.film");
    const std::string picture = kBall + "-o a.png --checkpoint a.film ";
    EXPECT_EQ(run(picture + first, folder.path()).exit_code, 0);
    const Ran ran = run(picture + then + " --resume", folder.path());
    EXPECT_EQ(ran.exit_code, 3) << then;
    return ran.err;
  };
  const std::string path = "--integrator path ";
  for (const auto& [first, then, difference] : std::vector<std::array<std::string, 3>>{
           {"--spp 16", "--spp 64", "--spp 16 there, 64 here"},
           {path + "--spp 10", path + "--spp 64", "--spp 10 there, 64 here"},
           {path + "--spp 16", path + "--spp 8", "--spp 16 there, 8 here"},
           {path + "--spp 4", "--spp 4 --depth 3",
            "--integrator path there, whitted here; --depth 8"},
           {path + "--spp 4", path + "--spp 4 --seed 3", "--seed 0 there, 3 here"},
           {"--spp 4", "--spp 4 --noise 0.1", "--noise not given there, 0.1 here"},
           {"--spp 4", "--spp 4 --crop 0,0,32,32", "--crop 0,0,80,60 there, 0,0,32,32 here"},
           {"--spp 4", "--spp 4 --build low", "--build medium there, low here"},
           {"--spp 4", "--spp 4 --isa sse2", "--isa best there, sse2 here"},
           {"--spp 4", "--spp 4 --aperture 0.1 --focus 2",
            "--aperture 0 there, 0.1 here; --focus 0 there, 2 here"},
           {"--integrator ao --spp 4 --reach 2", "--integrator ao --spp 4",
            "--reach 2 there, unlimited here"},
           {"--integrator direct --spp 4", "--integrator direct --spp 4 --no-shadows",
            "--no-shadows not given there, given here"},
           {path + "--spp 4", path + "--spp 4 --diffuse-depth 2",
            "--diffuse-depth 64 there, 2 here"},
           {"--spp 4", "--spp 4 --light default --light-strength 2", "another scene or light"}}) {
    const std::string text = why(first, then);
    EXPECT_NE(text.find(difference), std::string::npos) << text;
  }
}

TEST(Practice, ACheckpointOverwritesNothingElse) {
  const Folder folder;
  const std::string picture = kBall + "--spp 4 -o a.png --checkpoint ";
  folder.write("other.png", "somebody's");
  const Ran other = run(picture + "other.png", folder.path());
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("is no checkpoint"), std::string::npos) << other.err;
  EXPECT_EQ(folder.read("other.png"), "somebody's");
  folder.write("empty.film", "");
  EXPECT_EQ(run(picture + "empty.film", folder.path()).exit_code, 0);
  const std::string kept = folder.read("empty.film");
  for (const std::string& before : {std::string(), mpirun(2)}) {
    const Ran again = run(before + picture + "empty.film", folder.path());
    EXPECT_EQ(again.exit_code, 2) << again.err;
    EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
  }
  EXPECT_EQ(folder.read("empty.film"), kept);
}

// mpirun ends its processes by SIGTERM when it is interrupted, as is done here without it: it would
// kill them a second later, which is not enough where many other programs run.
TEST(Practice, AnInterruptedPictureOfProcessesGoesOnToTheSameBytes) {
  const Folder folder;
  const std::string picture = "--integrator path --spp 4000 -o a.exr --checkpoint a.film ";
  const Ran stopped = run(mpirun(2) + kBall + picture +
                              "--checkpoint-every 1000 --preview-every 0.01 & p=$!; "
                              "while [ ! -e a.exr ]; do sleep 0.01; done; "
                              "kill -TERM $(cat /proc/$p/task/*/children); wait $p",
                          folder.path());
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  ASSERT_TRUE(std::filesystem::exists(folder / "a.film")) << stopped.err;
  EXPECT_EQ(run(mpirun(2) + kBall + picture + "--resume --depth 2", folder.path()).exit_code, 3);
}

// What batch systems send before they kill.
TEST(Practice, APictureThatIsToldToEndIsKept) {
  const Folder folder;
  const std::string picture = "--integrator path --spp 4000 -o a.exr --checkpoint a.film ";
  const Ran stopped = run(kBall + picture +
                              "--checkpoint-every 1000 --preview-every 0.01 & p=$!; "
                              "while [ ! -e a.exr ]; do sleep 0.01; done; "
                              "kill -TERM $p; kill -TERM $p; wait $p",
                          folder.path());
  EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "a.film"));
}

// Ranks that share a scene out have no geometry when they look for a checkpoint.
TEST(Practice, ACheckpointBelongsToOneSceneHoweverItIsSharedOut) {
  const Folder folder;
  const std::string rest = kSmall + "--spp 8 -o a.png --checkpoint a.film ";
  const std::string shared = "--ranks 2 --data ray ";
  const std::string terrain = "delray render gen:terrain:500:";
  ASSERT_EQ(run(terrain + "1" + rest + shared, folder.path()).exit_code, 0);
  EXPECT_EQ(run(terrain + "2" + rest + shared + "--resume", folder.path()).exit_code, 3);
  EXPECT_EQ(run(terrain + "2" + rest + "--resume", folder.path()).exit_code, 3);
  EXPECT_EQ(run(terrain + "1" + rest + "--resume", folder.path()).exit_code, 0);
  EXPECT_EQ(run(terrain + "1" + rest + "--resume --data object", folder.path()).exit_code, 0);
}

TEST(Practice, NoiseAndTimeEndSampling) {
  const Folder folder;
  const json noisy = stats_of("--integrator path --spp 512 --noise 0.04 -o a.png", folder,
                              "delray render gen:cornell" + kSmall);
  EXPECT_GT(noisy["sampling"]["samples"], 16);
  EXPECT_LT(noisy["sampling"]["samples"], 256);
  EXPECT_FALSE(noisy["sampling"]["out_of_time"]);
  const json timed = stats_of("--integrator path --time 0.3 -o a.png", folder);
  EXPECT_TRUE(timed["sampling"]["out_of_time"]);
  EXPECT_GE(timed["sampling"]["samples"], 4);
}

TEST(Practice, NoiseAloneEndsAfterAModerateNumberOfSamples) {
  const Folder folder;
  const std::string picture = "delray render gen:cornell --engine raytrace --size 16x16 -q ";
  const std::string noise = "--integrator path --noise 0.0001 -o a.png ";
  const json alone = stats_of(noise, folder, picture);
  EXPECT_EQ(alone["options"]["spp"], 256);
  EXPECT_EQ(alone["sampling"]["samples"], 256);
  EXPECT_EQ(alone["sampling"]["noisy"], 1.0);
  EXPECT_EQ(stats_of(noise + "--spp 300", folder, picture)["sampling"]["samples"], 300);
  const json timed = stats_of(noise + "--time 0.1", folder, picture);
  EXPECT_EQ(timed["options"]["spp"], 65536);
  EXPECT_TRUE(timed["sampling"]["out_of_time"]);
  EXPECT_EQ(stats_of("--integrator path --noise 1 -o a.png", folder, picture)["sampling"]["noisy"],
            0.0);
}

TEST(Practice, ACropIsAPartOfThePicture) {
  const Folder folder;
  const std::string picture = "--integrator direct --spp 4 --background studio ";
  stats_of(picture + "-o whole.exr", folder);
  const json part = stats_of(picture + "--crop 21,13,30,40 -o part.exr", folder);
  EXPECT_EQ(part["image"]["width"], 30);
  const image::ImageF whole = image::read_image_float(folder / "whole.exr");
  const image::ImageF crop = image::read_image_float(folder / "part.exr");
  ASSERT_EQ(crop.width, 30);
  ASSERT_EQ(crop.height, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 30; ++x) {
      ASSERT_EQ(crop.colour[static_cast<std::size_t>(y * 30 + x)],
                whole.colour[static_cast<std::size_t>((y + 13) * 80 + x + 21)])
          << x << " " << y;
    }
  }
}

TEST(Practice, ACropIsToldWithItsOwnSize) {
  const Folder folder;
  const Ran ran =
      run("delray render gen:spheres:500 --engine raytrace --size 80x60 "
          "--crop 10,20,33,17 -o a.png",
          folder.path());
  EXPECT_NE(ran.err.find("a.png: 33 x 17, "), std::string::npos) << ran.err;
}

TEST(Practice, ChannelsAreInTheFile) {
  const Folder folder;
  stats_of("--integrator path --spp 8 --aovs --metadata -o a.exr", folder);
  const image::Picture picture = image::read_picture(folder / "a.exr");
  const auto values = [&](const std::string& name) {
    const auto found = std::find_if(picture.channels.begin(), picture.channels.end(),
                                    [&](const image::Channel& c) { return c.name == name; });
    EXPECT_NE(found, picture.channels.end()) << name;
    return found != picture.channels.end() ? found->values : std::vector<float>(80 * 60, 0.0F);
  };
  const std::vector<float> z = values("normal.Z"), samples = values("samples");
  const std::vector<float> ids = values("id.instance"), rays = values("cost.rays");
  values("normal.X"), values("albedo.G"), values("id.material"), values("variance");
  values("cost.seconds");
  EXPECT_EQ(*std::min_element(samples.begin(), samples.end()), 8.0F);
  EXPECT_GE(*std::max_element(ids.begin(), ids.end()), 1.0F);
  EXPECT_GE(*std::min_element(rays.begin(), rays.end()), 8.0F);
  for (std::size_t i = 0; i < z.size(); ++i) ASSERT_LE(std::abs(z[i]), 1.00001F);
  const bool told = std::any_of(
      picture.attributes.begin(), picture.attributes.end(),
      [](const image::Attribute& a) { return a.name.find("samples") != std::string::npos; });
  EXPECT_TRUE(told);
}

TEST(Practice, ExposureTonesAndSmoothingChangeWhatIsSeen) {
  const Folder folder;
  const std::string picture = "--integrator path --spp 4 -o a.png ";
  const auto mean = [&](const std::string& options) {
    stats_of(picture + options, folder);
    const image::ImageF shown = image::read_image_float(folder / "a.png");
    double sum = 0;
    for (std::size_t i = 0; i < shown.pixels(); ++i) sum += shown.colour[i].g;
    return sum / static_cast<double>(shown.pixels());
  };
  const double plain = mean("");
  EXPECT_GT(mean("--exposure 1"), plain * 1.2);
  EXPECT_LT(mean("--exposure -1"), plain * 0.8);
  EXPECT_NE(mean("--tone filmic"), plain);
  EXPECT_NEAR(mean("--denoise") / plain, 1.0, 0.05);
  for (const std::string name : {"normal", "instance", "rays", "variance", "depth"}) {
    EXPECT_GT(mean("--show " + name), 0.0) << name;
  }
  EXPECT_NE(mean("--aperture 0.5 --focus 3"), plain);
}

TEST(Practice, RaysGoAsFarAndThroughWhatIsAsked) {
  const Folder folder;
  const auto mean = [&](const std::string& options) {
    const Ran ran =
        run("delray render gen:cornell -o a.exr --size 48x48 --engine raytrace --stats f.json " +
                options,
            folder.path());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    const image::ImageF image = image::read_image_float(folder / "a.exr");
    double sum = 0;
    for (const image::RgbaF& c : image.colour.span()) sum += c.g;
    return sum / (48 * 48);
  };
  const double open = mean("--integrator ao --spp 4");
  EXPECT_GT(mean("--integrator ao --spp 4 --reach 0.05"), open * 1.2);
  const double shadowed = mean("--integrator direct");
  EXPECT_GT(mean("--integrator direct --no-shadows"), shadowed * 1.01);
  // Whatever the hierarchy, the picture is the same but for rounding.
  EXPECT_NEAR(mean("--integrator direct --build low"), shadowed, 1e-3 * shadowed);
  EXPECT_NEAR(mean("--integrator direct --build high --isa sse4.2"), shadowed, 1e-3 * shadowed);
  const json told = json::parse(folder.read("f.json"));
  EXPECT_EQ(told["options"]["build"], "high");
  EXPECT_EQ(told["options"]["isa"], "sse4.2");
}

TEST(Practice, OptionsWithoutEffectAreRefused) {
  const Folder folder;
  for (const std::string options :
       {"-o a.png --aovs", "-o a.exr --tone filmic", "-o a.png --resume", "-o a.png --focus 2",
        "-o a.png --checkpoint-every 3", "-o a.png --crop 60,0,30,10", "-o a.png --crop 1,2,3",
        "-o a.png --tone sepia", "-o a.png --show smell", "-o a.png --show rays --denoise",
        "-o a.png --turntable 3 --checkpoint a.film", "-o a.png --reach 1", "-o a.png --no-shadows",
        "-o a.png --isa mmx", "-o a.png --time 0", "-o a.png --noise 1e-300",
        "-o a.png --integrator ao --reach 1e-300", "-o a.png --aperture 1 --focus 1e300"}) {
    EXPECT_EQ(run(kBall + options, folder.path()).exit_code, 2) << options;
  }
  EXPECT_EQ(run("delray render gen:cornell -o a.png --denoise", folder.path()).exit_code, 2);
}

}  // namespace
}  // namespace delray::tests
