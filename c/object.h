// Objects of a device: parameters that are set, those that are committed, and who refers to whom.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "c/delray.h"

namespace delray::c {
struct Picture;
class Ref;
struct FrameState;
}  // namespace delray::c

// Shared by its objects, which may outlive its handle.
struct DelrayDevice_ {
  // One call at a time; deleters of arrays may call back.
  std::recursive_mutex mutex;
  int threads = 1;
  // Rises with every commit and unmapping of what scenes are made of.
  std::uint64_t scene_changes = 0;
  std::atomic<std::uint64_t> references{1};
};

namespace delray::c {

void retain(DelrayDevice device);
void release(DelrayDevice device);
void retain(DelrayObject object);
void release(DelrayObject object);  // with the device's mutex

// A counted reference.
class Ref {
 public:
  Ref() = default;
  explicit Ref(DelrayObject object) : object_(object) {
    if (object_ != nullptr) retain(object_);
  }
  Ref(const Ref& other) : Ref(other.object_) {}
  Ref(Ref&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Ref& operator=(Ref other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Ref() {
    if (object_ != nullptr) release(object_);
  }
  DelrayObject get() const { return object_; }

 private:
  DelrayObject object_ = nullptr;
};

// The value of a parameter.
struct Value {
  DelrayDataType type = DELRAY_UNKNOWN;
  std::vector<std::byte> bytes;  // of what is no handle
  Ref object;                    // of what is one
};

// Takes references to the handles that an array holds. Throws std::invalid_argument for handles of
// another type or device; then the array keeps what it had.
void keep_items(DelrayObject_& array);

// The bytes of one item. 0 for strings and what is unknown.
std::size_t size_of(DelrayDataType type);
bool is_object(DelrayDataType type);
std::string name_of(DelrayDataType type);  // "DELRAY_FLOAT32_VEC3"

// A parameter that objects of a kind have, with the types that it may be of.
struct ParameterRow {
  DelrayDataType kind;
  std::string_view subtypes;  // those that have it, between spaces; empty: all
  std::string_view name;
  std::vector<DelrayDataType> types;
};
std::span<const ParameterRow> parameter_rows();
// Whether there is such a subtype of a kind; kinds without subtypes have the one that is empty.
bool has_subtype(DelrayDataType kind, std::string_view subtype);
std::string subtypes_of(DelrayDataType kind);

}  // namespace delray::c

// What a handle points to: one object with its committed parameters.
struct DelrayObject_ {
  DelrayObject_(DelrayDevice of, DelrayDataType what, std::string which);
  ~DelrayObject_();
  DelrayObject_(const DelrayObject_&) = delete;
  DelrayObject_& operator=(const DelrayObject_&) = delete;

  DelrayDevice device;
  DelrayDataType kind;
  std::string subtype;
  std::atomic<std::uint64_t> references{1};
  std::map<std::string, delray::c::Value, std::less<>> pending, committed;

  // Of arrays.
  DelrayDataType item_type = DELRAY_UNKNOWN;
  std::uint64_t items[2] = {0, 1};
  const void* memory = nullptr;
  std::vector<std::byte> own_memory;
  std::vector<delray::c::Ref> item_objects;
  DelrayMemoryDeleter deleter = nullptr;
  const void* user_data = nullptr;
  bool is_mapped = false;

  // Of frames.
  std::unique_ptr<delray::c::FrameState> frame;

  // The committed value of a parameter, as T, or null. REQUIRES: its row has that type alone of its
  // size, or the caller looks at type_of.
  const delray::c::Value* find(std::string_view name) const {
    const auto found = committed.find(name);
    return found == committed.end() ? nullptr : &found->second;
  }
  template <class T>
  T value(std::string_view name, T otherwise) const {
    const delray::c::Value* const found = find(name);
    if (found == nullptr || found->bytes.size() != sizeof(T)) return otherwise;
    std::memcpy(&otherwise, found->bytes.data(), sizeof(T));
    return otherwise;
  }
  std::string text(std::string_view name, std::string_view otherwise) const;
  // Null where it is not there.
  DelrayObject object(std::string_view name) const {
    const delray::c::Value* const found = find(name);
    return found == nullptr ? nullptr : found->object.get();
  }
};
