#include "scenes/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

#include "files/error.h"
#include "files/read_file.h"
#include "image/io.h"
#include "tests/scenes/sample_files.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

Scene load_quietly(const std::filesystem::path& path) {
  std::vector<std::string> warnings;
  Scene scene = load(path, warnings);
  for (const std::string& w : warnings) ADD_FAILURE() << "warning: " << w;
  return scene;
}

void expect_valid(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  for (const Instance& i : scene.instances) ASSERT_LT(i.mesh, scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    const std::size_t n = mesh.positions.size();
    ASSERT_LT(mesh.material, scene.materials.size());
    ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == n);
    ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == n);
    ASSERT_TRUE(mesh.colours.empty() || mesh.colours.size() == n);
    for (const glm::uvec3& t : mesh.triangles) {
      ASSERT_LT(std::max({t.x, t.y, t.z}), n);
      ASSERT_TRUE(t.x != t.y && t.y != t.z && t.z != t.x);
    }
  }
}

glm::vec3 world(const Scene& scene, std::size_t instance, std::size_t triangle, int k) {
  const Instance& i = scene.instances[instance];
  const Mesh& mesh = scene.meshes[i.mesh];
  return i.transform * glm::vec4(mesh.positions[mesh.triangles[triangle][k]], 1);
}

TEST(Load, ShowsTheSceneOnceAsSoonAsItIsRead) {
  const tests::TemporaryFolder folder;
  folder.write("sample.mtl", "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.5 0.5 0.5\n");
  for (const SampleFile& file : sample_files()) {
    SCOPED_TRACE(file.name);
    std::vector<std::string> warnings;
    std::vector<Scene> seen;
    LoadOptions options;
    options.on_read = [&](const Scene& scene) { seen.push_back(scene); };
    const Scene scene = load(folder.write(file.name, file.content), warnings, options);
    ASSERT_EQ(seen.size(), 1U);
    expect_valid(seen[0]);
    EXPECT_EQ(triangle_count(seen[0]), file.triangles);
    EXPECT_EQ(bounds(seen[0]), bounds(scene));
    EXPECT_EQ(seen[0].z_up, scene.z_up);
    EXPECT_EQ(seen[0].origin, scene.origin);
  }
}

TEST(Load, ReadsTheSameTrianglesFromEveryFormat) {
  const tests::TemporaryFolder folder;
  folder.write("sample.mtl", "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.5 0.5 0.5\n");
  for (const SampleFile& file : sample_files()) {
    SCOPED_TRACE(file.name);
    const Scene scene = load_quietly(folder.write(file.name, file.content));
    expect_valid(scene);
    EXPECT_EQ(triangle_count(scene), file.triangles);
    if (file.triangles != 3) continue;
    EXPECT_EQ(bounds(scene), (geometry::Box3{{0, 0, 0}, {1, 1, 1}}));
    EXPECT_EQ(world(scene, 0, 0, 0), glm::vec3(0, 0, 0));
    EXPECT_EQ(world(scene, 0, 0, 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(world(scene, 0, 0, 2), glm::vec3(1, 1, 0));
    const std::size_t last = scene.meshes.back().triangles.size() - 1;
    const std::size_t end = scene.instances.size() - 1;
    geometry::Box3 box;
    for (int k = 0; k < 3; ++k) box.include(world(scene, end, last, k));
    EXPECT_EQ(box, (geometry::Box3{{0, 0, 0}, {1, 0, 1}}));
  }
}

TEST(Load, ContentCountsAndNotTheSuffix) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(triangle_count(load_quietly(folder.write("a.obj", sample_ply_binary(false)))), 3U);
  EXPECT_EQ(triangle_count(load_quietly(folder.write("b.ply", sample_off()))), 3U);
}

TEST(Load, JoinsTheEqualVerticesOfFormatsThatRepeatThem) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(load_quietly(folder.write("a.stl", sample_stl_binary())).meshes[0].positions.size(),
            5U);
  EXPECT_TRUE(load_quietly(folder / "a.stl").meshes[0].normals.empty());
  // Tiny models keep their vertices apart.
  const Scene tiny = load_quietly(
      folder.write("b.obj", "v 0 0 0\nv 1e-7 0 0\nv 0 1e-7 0\nv 1e-7 1e-7 0\nf 1 2 3\nf 2 4 3\n"));
  EXPECT_EQ(tiny.meshes[0].positions.size(), 4U);
  EXPECT_EQ(triangle_count(tiny), 2U);
}

TEST(Load, MtlMaterialsAndTextures) {
  const tests::TemporaryFolder folder;
  const std::vector<image::Rgba8> texels = {{255, 0, 0, 255}, {0, 255, 0, 255}};
  const std::vector<std::byte> png = image::encode_png(2, 1, texels);
  std::filesystem::create_directory(folder / "maps");
  folder.write("maps/wall.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  folder.write("sample.mtl",
               "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 30\nd 0.25\nmap_Kd maps\\wall.png\n"
               "newmtl grey\nKd 0.5 0.5 0.5\nKe 2 3 4\nNi 1.33\nmap_Kd missing.png\n");
  folder.write("a.obj", sample_obj());
  std::vector<std::string> warnings;
  const Scene scene = load(folder / "a.obj", warnings);
  const auto material = [&](const char* name) {
    return *std::find_if(scene.materials.begin(), scene.materials.end(),
                         [&](const Material& m) { return m.name == name; });
  };
  const Material red = material("red"), grey = material("grey");
  EXPECT_EQ(glm::vec3(red.base_colour), glm::vec3(1, 0, 0));
  EXPECT_EQ(red.alpha, Material::Alpha::blend);
  EXPECT_EQ(red.base_colour.a, 0.25F);
  EXPECT_NEAR(red.roughness, 0.5, 1e-5);
  ASSERT_NE(red.base_colour_texture, kNone);
  EXPECT_EQ(scene.textures[red.base_colour_texture].texels, texels);
  EXPECT_NEAR(grey.base_colour.x, 0.2140, 1e-3);
  EXPECT_EQ(grey.emission, glm::vec3(2, 3, 4));
  EXPECT_NEAR(grey.ior, 1.33, 1e-6);
  EXPECT_EQ(grey.base_colour_texture, kNone);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("missing.png"), std::string::npos);
  // v grows upwards in OBJ.
  EXPECT_EQ(scene.meshes[0].uvs[0], glm::vec2(0, 1));
}

TEST(Load, AMissingMaterialFileIsAWarning) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  const Scene scene = load(folder.write("a.obj", sample_obj()), warnings);
  EXPECT_EQ(triangle_count(scene), 3U);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].find("sample.mtl"), std::string::npos);
}

TEST(Load, ColoursOfVerticesAreMadeLinear) {
  const tests::TemporaryFolder folder;
  const Scene scene = load_quietly(folder.write("a.ply", sample_ply_text()));
  ASSERT_EQ(scene.meshes[0].colours.size(), 5U);
  EXPECT_EQ(scene.meshes[0].colours[0], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(scene.meshes[0].colours[4], glm::vec4(0, 0, 0, 1));
}

TEST(Load, DropsTrianglesWithEqualCornersAndTellsSo) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  const Scene scene =
      load(folder.write("a.off", "OFF 3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n3 0 1 2\n3 2 2 2\n"),
           warnings);
  EXPECT_EQ(triangle_count(scene), 1U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("2 triangles"), std::string::npos);
}

TEST(Load, FacesOverSeveralLinesAndPolygonsOfManyCorners) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(triangle_count(load_quietly(folder.write(
                "a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 \\\n3 4 5\n"))),
            3U);
}

TEST(Load, GuessesWhichWayIsUp) {
  const tests::TemporaryFolder folder;
  // A pyramid with an apex along y or z.
  const auto pyramid = [](bool z_up) {
    std::string off = "OFF\n5 5 0\n";
    for (const char* p : {"0 0", "1 0", "1 1", "0 1", "0.5 0.5"}) {
      const std::string a(p, std::strchr(p, ' ')), b(std::strchr(p, ' ') + 1);
      const std::string height = p[0] == '0' && p[1] == '.' ? "1" : "0";
      off += z_up ? a + " " + b + " " + height + "\n" : a + " " + height + " " + b + "\n";
    }
    return off + "4 0 1 2 3\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
  };
  EXPECT_TRUE(load_quietly(folder.write("z.off", pyramid(true))).z_up);
  EXPECT_FALSE(load_quietly(folder.write("y.off", pyramid(false))).z_up);
  EXPECT_FALSE(
      load_quietly(folder.write("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 1\n3 0 1 2\n")).z_up);
}

TEST(Load, SaysWhyNothingIsLeft) {
  const tests::TemporaryFolder folder;
  const auto reason = [&](const std::string& obj) {
    try {
      load_quietly(folder.write("a.obj", obj));
    } catch (const files::FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(reason("v 1 0 0\nv 2 0 0\nv 1 0 0\nf 1 2 3\n")
                  .ends_with("its 1 triangle has two corners in one place"));
  EXPECT_TRUE(reason("v 1 0 0\nv 2 0 0\nv 1 0 0\nf 1 2 3\nf 3 2 1\n")
                  .ends_with("its 2 triangles have two corners in one place"));
  EXPECT_NE(reason("v 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2\n").find("no triangles in the file"),
            std::string::npos);
}

TEST(Load, GltfTransformsNamesAndMaterials) {
  const tests::TemporaryFolder folder;
  const Scene scene = load_quietly(folder.write("a.gltf", sample_gltf()));
  EXPECT_EQ(scene.meshes.size(), 1U);
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].transform[3], glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.instances[1].transform, glm::mat4x3(glm::vec3(2, 0, 0), glm::vec3(0, 2, 0),
                                                      glm::vec3(0, 0, 2), glm::vec3(1, 2, 3)));
  EXPECT_EQ(scene.meshes[0].name, "thing");
  EXPECT_EQ(scene.materials[0].base_colour, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(scene.materials[0].metallic, 0);
}

// The text between the quotes of `from` once, by `to`.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Load, GltfStripsFansAndUnindexedTriangles) {
  const tests::TemporaryFolder folder;
  const auto load_mode = [&](const char* mode) {
    return load_quietly(folder.write(
        "a.gltf", with(sample_gltf(), "\"indices\":1,", "\"mode\":" + std::string(mode) + ",")));
  };
  const Scene strip = load_mode("5"), fan = load_mode("6");
  EXPECT_EQ(strip.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(fan.meshes[0].triangles, (std::vector<glm::uvec3>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_THROW(load_mode("7"), files::FileError);
  const Scene plain = load_mode("4");
  EXPECT_EQ(plain.meshes[0].triangles, (std::vector<glm::uvec3>{{0, 1, 2}}));
  EXPECT_EQ(plain.meshes[0].positions.size(), 3U);  // no triangle uses the others
}

TEST(Load, GltfPointsAndLinesOfEachMode) {
  const tests::TemporaryFolder folder;
  const auto load_mode = [&](const char* mode) {
    return load_quietly(folder.write(
        "a.gltf", with(sample_gltf(), "\"indices\":1,", "\"mode\":" + std::string(mode) + ",")));
  };
  using Segments = std::vector<glm::uvec3>;
  const Scene points = load_mode("0"), lines = load_mode("1"), loop = load_mode("2");
  EXPECT_EQ(points.meshes[0].shape.kind, Shape::Kind::point);
  EXPECT_EQ(points.meshes[0].triangles,
            (Segments{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}));
  EXPECT_EQ(splat_count(points), 5 * points.instances.size());
  EXPECT_EQ(triangle_count(points), 0U);
  EXPECT_TRUE(points.materials[points.meshes[0].material].unlit);
  EXPECT_EQ(lines.meshes[0].shape.kind, Shape::Kind::line);
  EXPECT_EQ(lines.meshes[0].triangles, (Segments{{0, 1, 1}, {2, 3, 3}}));
  EXPECT_EQ(lines.meshes[0].positions.size(), 4U);
  EXPECT_EQ(loop.meshes[0].triangles,
            (Segments{{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 4, 4}, {4, 0, 0}}));
  EXPECT_EQ(load_mode("3").meshes[0].triangles,
            (Segments{{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 4, 4}}));
}

TEST(Load, GltfCamerasOfBothKindsWithTheirNames) {
  const tests::TemporaryFolder folder;
  const std::string gltf =
      with(with(sample_gltf(), "\"children\":[1]}",
                R"("children":[1]},{"camera":1,"name":"plan","translation":[0,0,9]},
{"camera":0,"translation":[0,0,20]})"),
           "\"scenes\":[{\"nodes\":[0]}]", R"("scenes":[{"nodes":[0,3,2]}],
"cameras":[{"name":"lens","type":"perspective","perspective":{"yfov":1,"znear":0.5}},
{"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0.25,"zfar":1000}}])");
  // The nodes are 0, then the two cameras, then what was node 1.
  const Scene scene =
      load_quietly(folder.write("a.gltf", with(with(gltf, "\"children\":[1]", "\"children\":[3]"),
                                               "\"nodes\":[0,3,2]", "\"nodes\":[0,2,1]")));
  ASSERT_EQ(scene.cameras.size(), 2U);
  const Camera &lens = scene.cameras[0], &plan = scene.cameras[1];
  EXPECT_EQ(lens.name, "lens");
  EXPECT_FALSE(lens.orthographic());
  EXPECT_NEAR(lens.vertical_fov, 57.29578, 1e-4);
  EXPECT_EQ(plan.name, "plan");
  EXPECT_EQ(plan.height, 4);
  EXPECT_EQ(plan.eye, glm::vec3(0, 0, 9));
  // The scene reaches from z = 3 to 5, that is from 4 to 6 before the camera.
  EXPECT_NEAR(plan.near, 4, 0.01);
  EXPECT_NEAR(plan.far, 6, 0.01);
  for (const char* ymag : {"0", "1e-30"}) {
    EXPECT_THROW(
        load_quietly(folder.write("b.gltf", with(files::read_file(folder / "a.gltf"), "\"ymag\":2",
                                                 "\"ymag\":" + std::string(ymag)))),
        files::FileError);
  }
}

TEST(Load, GltfSparseAndQuantizedPositions) {
  const tests::TemporaryFolder folder;
  // Vertex 4 is replaced by what the positions of vertex 2 are; its number is index 1 of the
  // indices.
  const Scene sparse = load_quietly(folder.write(
      "a.gltf", with(sample_gltf(), "\"count\":5,",
                     "\"count\":5,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":1,"
                     "\"byteOffset\":16,\"componentType\":5123},\"values\":{\"bufferView\":0,"
                     "\"byteOffset\":24}},")));
  EXPECT_EQ(sparse.meshes[0].positions[4], glm::vec3(1, 1, 0));

  std::string bytes;
  for (const int x : {0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0})
    append(bytes, static_cast<std::int16_t>(x));
  const Scene quantized = load_quietly(folder.write(
      "b.gltf",
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":24,"byteStride":8}],
"buffers":[{"byteLength":24,"uri":"data:;base64,)" +
          base64(bytes) + "\"}]}"));
  EXPECT_EQ(quantized.meshes[0].positions,
            (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

// The sample with an object in place of its material, and the scene's first material.
Material gltf_material(const tests::TemporaryFolder& folder, const std::string& json,
                       std::vector<std::string>& warnings) {
  const std::string red =
      R"({"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0}})";
  return load(folder.write("a.gltf", with(sample_gltf(), red, json)), warnings).materials[0];
}

TEST(Load, GltfExtensionsOfMaterials) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  const Material m = gltf_material(folder, R"({"extensions":{
"KHR_materials_ior":{"ior":1.4},
"KHR_materials_emissive_strength":{"emissiveStrength":5},
"KHR_materials_specular":{"specularFactor":0.25,"specularColorFactor":[1,0.5,2]},
"KHR_materials_clearcoat":{"clearcoatFactor":0.75,"clearcoatRoughnessFactor":0.125},
"KHR_materials_sheen":{"sheenColorFactor":[0.5,0.25,1],"sheenRoughnessFactor":0.375},
"KHR_materials_transmission":{"transmissionFactor":0.5},
"KHR_materials_volume":{"thicknessFactor":2,"attenuationDistance":3,"attenuationColor":[1,0,0.5]}},
"emissiveFactor":[1,0.5,0]})",
                                   warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_FALSE(m.unlit);
  EXPECT_EQ(m.ior, 1.4F);
  EXPECT_EQ(m.emission, glm::vec3(5, 2.5F, 0));
  EXPECT_EQ(m.specular, 0.25F);
  EXPECT_EQ(m.specular_colour, glm::vec3(1, 0.5F, 2));
  EXPECT_EQ(m.clearcoat, 0.75F);
  EXPECT_EQ(m.clearcoat_roughness, 0.125F);
  EXPECT_EQ(m.sheen_colour, glm::vec3(0.5F, 0.25F, 1));
  EXPECT_EQ(m.sheen_roughness, 0.375F);
  EXPECT_EQ(m.transmission, 0.5F);
  EXPECT_EQ(m.thickness, 2.0F);
  EXPECT_EQ(m.attenuation_distance, 3.0F);
  EXPECT_EQ(m.attenuation_colour, glm::vec3(1, 0, 0.5F));
  const Material pane = gltf_material(
      folder, R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})",
      warnings);
  EXPECT_EQ(pane.thickness, 0.0F);
  const Material mirror =
      gltf_material(folder, R"({"extensions":{"KHR_materials_ior":{"ior":0}}})", warnings);
  EXPECT_GT(mirror.ior, 100.0F);
  EXPECT_TRUE(
      gltf_material(folder, R"({"extensions":{"KHR_materials_unlit":{}}})", warnings).unlit);
  EXPECT_TRUE(warnings.empty());
}

TEST(Load, GltfWarnsOfExtensionsThatAreLeftOut) {
  const tests::TemporaryFolder folder;
  std::vector<std::string> warnings;
  gltf_material(folder, R"({"extensions":{"KHR_materials_iridescence":{"iridescenceFactor":1},
"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0}}}})",
                warnings);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("clearcoatNormalTexture"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("materials[0].extensions.KHR_materials_iridescence"),
            std::string::npos)
      << warnings[1];
}

TEST(Load, GltfReadsBuffersBesideIt) {
  const tests::TemporaryFolder folder;
  std::string gltf = sample_gltf();
  const std::size_t at = gltf.find("data:");
  std::string bytes;
  for (const float x : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1}) append(bytes, x);
  for (const int i : {0, 1, 2, 0, 2, 3, 0, 1, 4}) append(bytes, static_cast<std::uint16_t>(i));
  gltf.replace(at, gltf.find('"', at) - at, "with%20blank.bin");
  folder.write("a.gltf", gltf);
  EXPECT_THROW(load_quietly(folder / "a.gltf"), files::FileError);
  folder.write("with blank.bin", bytes);
  EXPECT_EQ(triangle_count(load_quietly(folder / "a.gltf")), 6U);
}

struct Model {
  const char* file;
  std::size_t triangles;
  std::size_t dropped;  // with two corners in one place
};

TEST(Load, RealModelsHaveTheirTriangles) {
  const std::filesystem::path folder = DELRAY_SHARED_DATA;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no sample models in " << folder;
  for (const Model& model :
       {Model{"stanford-bunny.obj", 69451, 0}, Model{"nefertiti.obj", 99938, 0},
        Model{"teapot.obj", 6320, 0}, Model{"spot.obj", 5856, 0},
        Model{"2CylinderEngine.glb", 110336, 10419}, Model{"drone/scene.gltf", 32720, 0}}) {
    SCOPED_TRACE(model.file);
    std::vector<std::string> warnings;
    const Scene scene = load(folder / model.file, warnings);
    expect_valid(scene);
    EXPECT_EQ(triangle_count(scene), model.triangles);
    if (model.dropped == 0) continue;
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings[0].find(std::to_string(model.dropped) + " triangles"), std::string::npos);
  }
}

TEST(Load, RealModelsKeepInstancesTexturesAndUp) {
  const std::filesystem::path folder = DELRAY_SHARED_DATA;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no sample models in " << folder;
  std::vector<std::string> warnings;
  const Scene engine = load(folder / "2CylinderEngine.glb", warnings);
  EXPECT_GT(engine.instances.size(), 2 * engine.meshes.size());
  const Scene drone = load(folder / "drone/scene.gltf", warnings);
  EXPECT_EQ(drone.materials.size(), 3U);
  ASSERT_FALSE(drone.textures.empty());
  for (const Texture& t : drone.textures) {
    EXPECT_EQ(t.texels.size(),
              static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height));
  }
  for (const Material& m : drone.materials) {
    ASSERT_NE(m.normal_texture, kNone);
    ASSERT_NE(m.base_colour_texture, kNone);
    EXPECT_FALSE(drone.textures[m.normal_texture].srgb);
    EXPECT_TRUE(drone.textures[m.base_colour_texture].srgb);
  }
  EXPECT_TRUE(load(folder / "nefertiti.obj", warnings).z_up);
  EXPECT_FALSE(load(folder / "stanford-bunny.obj", warnings).z_up);
  EXPECT_FALSE(load(folder / "teapot.obj", warnings).z_up);
}

}  // namespace
}  // namespace delray::scenes
