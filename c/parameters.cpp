// The table of parameters: names and types are those of ANARI 1.0; docs/c.md says what they mean.
#include <array>

#include "c/object.h"

namespace delray::c {

std::span<const ParameterRow> parameter_rows() {
  using Types = std::vector<DelrayDataType>;
  static const Types number = {DELRAY_FLOAT32}, vector = {DELRAY_FLOAT32_VEC3},
                     text = {DELRAY_STRING}, array = {DELRAY_ARRAY1D}, count = {DELRAY_INT32},

                     colour = {DELRAY_FLOAT32_VEC3, DELRAY_FLOAT32_VEC4, DELRAY_SAMPLER,
                               DELRAY_STRING};
  static const std::vector<ParameterRow> rows = {
      {DELRAY_CAMERA, "", "position", vector},
      {DELRAY_CAMERA, "", "direction", vector},
      {DELRAY_CAMERA, "", "up", vector},
      {DELRAY_CAMERA, "", "aspect", number},
      {DELRAY_CAMERA, "", "near", number},
      {DELRAY_CAMERA, " orthographic ", "far", number},
      {DELRAY_CAMERA, " perspective ", "fovy", number},
      {DELRAY_CAMERA, " perspective ", "apertureRadius", number},
      {DELRAY_CAMERA, " perspective ", "focusDistance", number},
      {DELRAY_CAMERA, " orthographic ", "height", number},

      {DELRAY_GEOMETRY, "", "vertex.position", array},
      {DELRAY_GEOMETRY, "", "vertex.color", array},
      {DELRAY_GEOMETRY, " triangle ", "vertex.normal", array},
      {DELRAY_GEOMETRY, " triangle ", "vertex.attribute0", array},
      {DELRAY_GEOMETRY, " triangle ", "primitive.index", array},
      {DELRAY_GEOMETRY, " sphere ", "radius", number},

      {DELRAY_MATERIAL, " matte ", "color", colour},
      {DELRAY_MATERIAL, " matte ", "opacity", {DELRAY_FLOAT32}},
      {DELRAY_MATERIAL, " physicallyBased ", "baseColor", colour},
      {DELRAY_MATERIAL, " physicallyBased ", "opacity", {DELRAY_FLOAT32}},
      {DELRAY_MATERIAL, " physicallyBased ", "metallic", number},
      {DELRAY_MATERIAL, " physicallyBased ", "roughness", number},
      {DELRAY_MATERIAL, " physicallyBased ", "specular", number},
      {DELRAY_MATERIAL, " physicallyBased ", "specularColor", vector},
      {DELRAY_MATERIAL, " physicallyBased ", "clearcoat", number},
      {DELRAY_MATERIAL, " physicallyBased ", "clearcoatRoughness", number},
      {DELRAY_MATERIAL, " physicallyBased ", "sheenColor", vector},
      {DELRAY_MATERIAL, " physicallyBased ", "sheenRoughness", number},
      {DELRAY_MATERIAL, " physicallyBased ", "transmission", number},
      {DELRAY_MATERIAL, " physicallyBased ", "ior", number},
      {DELRAY_MATERIAL, " physicallyBased ", "thickness", number},
      {DELRAY_MATERIAL, " physicallyBased ", "attenuationDistance", number},
      {DELRAY_MATERIAL, " physicallyBased ", "attenuationColor", vector},
      {DELRAY_MATERIAL, " physicallyBased ", "emissive", vector},
      {DELRAY_MATERIAL, "", "alphaMode", text},
      {DELRAY_MATERIAL, "", "alphaCutoff", number},

      {DELRAY_SAMPLER, "", "image", {DELRAY_ARRAY2D}},
      {DELRAY_SAMPLER, "", "inAttribute", text},
      {DELRAY_SAMPLER, "", "wrapMode1", text},
      {DELRAY_SAMPLER, "", "wrapMode2", text},

      {DELRAY_LIGHT, "", "color", vector},
      {DELRAY_LIGHT, " directional ", "irradiance", number},
      {DELRAY_LIGHT, " directional ", "direction", vector},
      {DELRAY_LIGHT, " point ", "position", vector},
      {DELRAY_LIGHT, " point ", "intensity", number},
      {DELRAY_LIGHT, " quad ", "position", vector},
      {DELRAY_LIGHT, " quad ", "edge1", vector},
      {DELRAY_LIGHT, " quad ", "edge2", vector},
      {DELRAY_LIGHT, " quad ", "radiance", number},

      {DELRAY_SURFACE, "", "geometry", {DELRAY_GEOMETRY}},
      {DELRAY_SURFACE, "", "material", {DELRAY_MATERIAL}},
      {DELRAY_GROUP, "", "surface", array},
      {DELRAY_GROUP, "", "light", array},
      {DELRAY_INSTANCE, "", "group", {DELRAY_GROUP}},
      {DELRAY_INSTANCE, "", "transform", {DELRAY_FLOAT32_MAT4}},
      {DELRAY_WORLD, "", "instance", array},
      {DELRAY_WORLD, "", "surface", array},
      {DELRAY_WORLD, "", "light", array},

      {DELRAY_RENDERER, "", "background", {DELRAY_FLOAT32_VEC4}},
      {DELRAY_RENDERER, "", "ambientColor", vector},
      {DELRAY_RENDERER, "", "ambientRadiance", number},
      {DELRAY_RENDERER, "", "pixelSamples", count},
      {DELRAY_RENDERER, "", "compositing", text},  // data-parallel frames: a scheme
      {DELRAY_RENDERER, " raytrace ", "integrator", text},
      {DELRAY_RENDERER, " raytrace ", "maxDepth", count},

      {DELRAY_FRAME, "", "world", {DELRAY_WORLD}},
      {DELRAY_FRAME, "", "camera", {DELRAY_CAMERA}},
      {DELRAY_FRAME, "", "renderer", {DELRAY_RENDERER}},
      {DELRAY_FRAME, "", "size", {DELRAY_UINT32_VEC2}},
      {DELRAY_FRAME, "", "channel.color", {DELRAY_DATA_TYPE}},
      {DELRAY_FRAME, "", "channel.depth", {DELRAY_DATA_TYPE}},
      {DELRAY_FRAME, "", "mpiCommunicator", {DELRAY_VOID_POINTER}},
      // Any object may have a name, for its owner.
      {DELRAY_CAMERA, "", "name", text},
      {DELRAY_GEOMETRY, "", "name", text},
      {DELRAY_MATERIAL, "", "name", text},
      {DELRAY_SAMPLER, "", "name", text},
      {DELRAY_LIGHT, "", "name", text},
      {DELRAY_SURFACE, "", "name", text},
      {DELRAY_GROUP, "", "name", text},
      {DELRAY_INSTANCE, "", "name", text},
      {DELRAY_WORLD, "", "name", text},
      {DELRAY_RENDERER, "", "name", text},
      {DELRAY_FRAME, "", "name", text},
  };
  return rows;
}

}  // namespace delray::c
