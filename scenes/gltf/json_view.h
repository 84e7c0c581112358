// Reading JSON that may be anything: every access is checked and errors say where.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes/files/source.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

using Json = nlohmann::json;

// A value of a document, or its absence. Values of the wrong type fail as bad input that names
// their place ("materials[3].alphaCutoff").
class JsonView {
 public:
  JsonView(const Source& source, const Json* json, std::string place)
      : source_(&source),
        json_(json && json->is_null() ? nullptr : json),
        place_(std::move(place)) {}

  explicit operator bool() const { return json_ != nullptr; }
  bool is_object() const { return json_ && json_->is_object(); }
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& what) const { source_->fail(place_, what); }

  JsonView operator[](const char* key) const;  // of an object; absent if it or the key is
  std::vector<std::string> keys() const;       // of an object; none if absent
  std::size_t size() const;                    // of an array; 0 if absent
  JsonView operator[](std::size_t i) const;    // REQUIRES: i < size()

  double number(double otherwise) const;  // finite, at most 1e18 in magnitude
  double number(double otherwise, double low, double high) const;  // clamped
  double non_negative(double otherwise) const;                     // finite, from 0 to 1e18
  // A whole number from 0 to 2^53.
  std::uint64_t whole(std::uint64_t otherwise) const;
  std::uint64_t whole() const;
  // A number of something of which there are `count`; kNone if absent.
  std::uint32_t reference(std::size_t count) const;
  bool flag(bool otherwise) const;
  std::string text(const std::string& otherwise = "") const;

  template <int N>
  glm::vec<N, double> vector(const glm::vec<N, double>& otherwise) const {
    if (!json_) return otherwise;
    if (size() != static_cast<std::size_t>(N)) fail("needs " + std::to_string(N) + " numbers");
    glm::vec<N, double> v;
    for (int i = 0; i < N; ++i) v[i] = (*this)[static_cast<std::size_t>(i)].number(0);
    return v;
  }

  template <int N>
  glm::vec<N, double> non_negative_vector(const glm::vec<N, double>& otherwise) const {
    const glm::vec<N, double> v = vector<N>(otherwise);
    for (int i = 0; json_ && i < N; ++i) (*this)[static_cast<std::size_t>(i)].non_negative(0);
    return v;
  }

 private:
  const Source* source_;
  const Json* json_;
  std::string place_;
};

}  // namespace delray::scenes::internal
