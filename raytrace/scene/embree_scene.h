// The acceleration structure: all that the project knows of Embree is behind this file.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "raytrace/scene/geometry_instance.h"
#include "raytrace/scene/ray.h"

namespace delray::raytrace {

struct BuildOptions {
  // How much time to spend on a better structure; `high` splits triangles and takes most memory.
  enum class Quality : std::uint8_t { low, medium, high } quality = Quality::medium;
  bool robust = true;        // no ray slips between two triangles that share an edge
  bool share_meshes = true;  // meshes placed more than once become Embree instances
  bool changing = false;     // EmbreeScene::change, move; half as much memory again
  // A mesh that bends has its structure refitted for as long as a ray is expected to cost no more
  // than so many times what it cost when that was built (RefitCost; Lauterbach et al. 2006).
  double refit_limit = 1.4;
  std::string isa;  // sse2, sse4.2, avx, avx2, avx512 (where present); empty: the best
};

// One of Embree's devices. Those of many small scenes have one in common: a process has room for
// some hundreds. Copies are the same device.
class EmbreeDevice {
 public:
  // Throws std::bad_alloc when memory runs out, std::runtime_error on any other failure.
  explicit EmbreeDevice(const BuildOptions& options);

  std::uint64_t memory() const;  // bytes that Embree holds for all its scenes
  std::string version() const;   // of the library, e.g. "3.13.5"
  std::string isa() const;       // in use: sse2, sse4.2, avx, avx2, avx512, neon

 private:
  friend class EmbreeScene;
  struct State;
  std::shared_ptr<State> state_;
};

// Any number of threads may send rays at the same time.
class EmbreeScene {
 public:
  // Builds in the caller's arena; scenes of one device one after the other, or memory() of one
  // counts some of another. Buffers of `instances` are used in place and have to outlive the
  // object. Degenerate triangles are never hit. O(n log n).
  // Throws std::bad_alloc when memory runs out, std::runtime_error on any other failure.
  // Where it is part of a scene, `numbers` has an element for each instance and outlives the
  // object: ties are broken by what they are in the whole scene, hits still tell what they are in
  // the part. There several instances may be pieces of one that is placed by a transform: with
  // other meshes, but the same mesh_number and number in the whole scene.
  EmbreeScene(std::span<const GeometryInstance> instances, const BuildOptions& options,
              const EmbreeDevice& device, std::span<const GeometryNumbers> numbers = {});
  // On a device of its own.
  EmbreeScene(std::span<const GeometryInstance> instances, const BuildOptions& options)
      : EmbreeScene(instances, options, EmbreeDevice(options)) {}
  ~EmbreeScene();
  EmbreeScene(EmbreeScene&&) noexcept;
  EmbreeScene& operator=(EmbreeScene&&) noexcept;

  // Elements `changed` of `instances` are others than before; those with a null mesh are taken
  // away. `instances` and `numbers` are all of them, and may lie elsewhere than before. Those with
  // the same mesh come and go together. O(n log n) of the triangles that come, with
  // BuildOptions::changing, else of all. REQUIRES: no rays meanwhile.
  void change(std::span<const std::uint32_t> changed, std::span<const GeometryInstance> instances,
              std::span<const GeometryNumbers> numbers);

  // Instances that have other transforms than before, of those that are Embree instances, and
  // others whose vertices changed, by their places; `rebuild`: the structure over those is built
  // anew, otherwise it is refitted. O(changed vertices + instances). REQUIRES: no rays meanwhile;
  // BuildOptions::changing; vertices of the same number, and instances at the same places as when
  // they were built; GeometryInstance::deforming of those that bend.
  void move(std::span<const std::uint32_t> moved, std::span<const std::uint32_t> bent, bool rebuild,
            std::span<const GeometryInstance> instances);

  // Nearest hits; `coherent`: the rays of a packet stay close to each other, which makes it faster
  // and changes nothing else. Where a ray goes through an edge or a corner and meets several
  // triangles at exactly the same distance, that of the lowest instance, then triangle, number is
  // taken: always the same, however the triangles are dealt out to scenes. Of surfaces that lie in
  // each other any one is taken, always the same for the same scene, ray and instruction set.
  void intersect(Ray& ray) const;
  void intersect(const ActiveRays& active, RayPacket& packet, bool coherent) const;

  // Whether anything opaque is on the way. What can be seen through (GeometryInstance::see_through,
  // but for triangles that are opaque) is put into `passed` instead, once each. A negative `far` on
  // return: occluded.
  bool occluded(Ray& ray, SeeThrough& passed) const;
  void occluded(const ActiveRays& active, ShadowPacket& packet,
                std::span<SeeThrough, kPacketRays> passed, bool coherent) const;

  // The matrix by which Embree brings rays to the space of an instance of `instances`, the
  // scene's: the inverse of `to_world` to the last bit as it is computed there. The unit matrix of
  // those that are no Embree instances; not a number where the transform has no inverse.
  // O(instances log instances). Throws as the constructor.
  std::vector<glm::mat4x3> to_local(std::span<const GeometryInstance> instances) const;
  // Of what an instance's transform brings to the world, before that: what Embree makes the box
  // of in the world. Empty where it is no Embree instance.
  geometry::Box3 local_bounds(std::uint32_t instance) const;

  bool has_see_through() const { return has_see_through_; }
  bool has_splats() const { return has_splats_; }  // points or segments beside triangles
  bool is_robust() const;                          // BuildOptions::robust
  std::uint64_t memory() const;                    // bytes that Embree took for this scene
  geometry::Box3 bounds() const;                   // of all that can be hit
  const EmbreeDevice& device() const;

  struct State;  // Embree's objects

 private:
  std::unique_ptr<State> state_;
  bool has_see_through_ = false;
  bool has_instances_ = false;
  bool has_splats_ = false;
};

}  // namespace delray::raytrace
