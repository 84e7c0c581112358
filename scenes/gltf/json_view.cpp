// Access to JSON values with defaults: an absent value gives the default, one of the wrong type, or
// a number that is not finite or too large, is bad input that names its place.
#include "scenes/gltf/json_view.h"

#include <algorithm>
#include <cmath>

namespace delray::scenes::internal {

JsonView JsonView::operator[](const char* key) const {
  std::string place = place_.empty() ? key : place_ + "." + key;
  if (!json_) return {*source_, nullptr, std::move(place)};
  if (!json_->is_object()) fail("should be an object");
  const auto found = json_->find(key);
  return {*source_, found == json_->end() ? nullptr : &*found, std::move(place)};
}

std::vector<std::string> JsonView::keys() const {
  std::vector<std::string> result;
  if (!json_) return result;
  if (!json_->is_object()) fail("should be an object");
  for (const auto& item : json_->items()) result.push_back(item.key());
  return result;
}

std::size_t JsonView::size() const {
  if (!json_) return 0;
  if (!json_->is_array()) fail("should be an array");
  return json_->size();
}

JsonView JsonView::operator[](std::size_t i) const {
  return {*source_, &(*json_)[i], place_ + "[" + std::to_string(i) + "]"};
}

double JsonView::number(double otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_number()) fail("should be a number");
  const double value = json_->get<double>();
  if (!(std::abs(value) <= kLargestCoordinate)) fail("is not finite or larger than 1e18");
  return value;
}

double JsonView::number(double otherwise, double low, double high) const {
  return std::clamp(number(otherwise), low, high);
}

double JsonView::non_negative(double otherwise) const {
  const double value = number(otherwise);
  if (value < 0) fail("should not be negative");
  return value;
}

std::uint64_t JsonView::whole(std::uint64_t otherwise) const { return json_ ? whole() : otherwise; }

std::uint64_t JsonView::whole() const {
  if (!json_) fail("is missing");
  const double value = number(0);
  if (value < 0 || value > 0x1p53 || value != std::floor(value)) fail("should be a whole number");
  return static_cast<std::uint64_t>(value);
}

std::uint32_t JsonView::reference(std::size_t count) const {
  if (!json_) return kNone;
  const std::uint64_t value = whole();
  if (value >= count) {
    fail("there is no number " + std::to_string(value) + " (" + std::to_string(count) +
         ", counted from 0)");
  }
  return static_cast<std::uint32_t>(value);
}

bool JsonView::flag(bool otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_boolean()) fail("should be true or false");
  return json_->get<bool>();
}

std::string JsonView::text(const std::string& otherwise) const {
  if (!json_) return otherwise;
  if (!json_->is_string()) fail("should be a string");
  return json_->get<std::string>();
}

}  // namespace delray::scenes::internal
