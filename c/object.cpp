// Parameters as rows of a table: setting one checks its name and type.
#include "c/object.h"

#include <algorithm>
#include <thread>

#include "c/frame_state.h"
#include "c/guard.h"

namespace delray::c {
namespace {

struct TypeRow {
  DelrayDataType type;
  const char* name;
  std::size_t size;
};

constexpr TypeRow kTypes[] = {
    {DELRAY_STRING, "DELRAY_STRING", 0},
    {DELRAY_BOOL, "DELRAY_BOOL", 4},
    {DELRAY_VOID_POINTER, "DELRAY_VOID_POINTER", sizeof(void*)},
    {DELRAY_DATA_TYPE, "DELRAY_DATA_TYPE", sizeof(DelrayDataType)},
    {DELRAY_INT32, "DELRAY_INT32", 4},
    {DELRAY_UINT32, "DELRAY_UINT32", 4},
    {DELRAY_UINT32_VEC2, "DELRAY_UINT32_VEC2", 8},
    {DELRAY_UINT32_VEC3, "DELRAY_UINT32_VEC3", 12},
    {DELRAY_UINT64, "DELRAY_UINT64", 8},
    {DELRAY_FLOAT32, "DELRAY_FLOAT32", 4},
    {DELRAY_FLOAT32_VEC2, "DELRAY_FLOAT32_VEC2", 8},
    {DELRAY_FLOAT32_VEC3, "DELRAY_FLOAT32_VEC3", 12},
    {DELRAY_FLOAT32_VEC4, "DELRAY_FLOAT32_VEC4", 16},
    {DELRAY_FLOAT32_MAT4, "DELRAY_FLOAT32_MAT4", 64},
    {DELRAY_FLOAT32_BOX3, "DELRAY_FLOAT32_BOX3", 24},
    {DELRAY_FLOAT64, "DELRAY_FLOAT64", 8},
    {DELRAY_UFIXED8_VEC3, "DELRAY_UFIXED8_VEC3", 3},
    {DELRAY_UFIXED8_VEC4, "DELRAY_UFIXED8_VEC4", 4},
    {DELRAY_UFIXED8_RGB_SRGB, "DELRAY_UFIXED8_RGB_SRGB", 3},
    {DELRAY_UFIXED8_RGBA_SRGB, "DELRAY_UFIXED8_RGBA_SRGB", 4},
    {DELRAY_ARRAY1D, "DELRAY_ARRAY1D", sizeof(DelrayObject)},
    {DELRAY_ARRAY2D, "DELRAY_ARRAY2D", sizeof(DelrayObject)},
    {DELRAY_CAMERA, "DELRAY_CAMERA", sizeof(DelrayObject)},
    {DELRAY_FRAME, "DELRAY_FRAME", sizeof(DelrayObject)},
    {DELRAY_GEOMETRY, "DELRAY_GEOMETRY", sizeof(DelrayObject)},
    {DELRAY_GROUP, "DELRAY_GROUP", sizeof(DelrayObject)},
    {DELRAY_INSTANCE, "DELRAY_INSTANCE", sizeof(DelrayObject)},
    {DELRAY_LIGHT, "DELRAY_LIGHT", sizeof(DelrayObject)},
    {DELRAY_MATERIAL, "DELRAY_MATERIAL", sizeof(DelrayObject)},
    {DELRAY_RENDERER, "DELRAY_RENDERER", sizeof(DelrayObject)},
    {DELRAY_SAMPLER, "DELRAY_SAMPLER", sizeof(DelrayObject)},
    {DELRAY_SURFACE, "DELRAY_SURFACE", sizeof(DelrayObject)},
    {DELRAY_WORLD, "DELRAY_WORLD", sizeof(DelrayObject)},
};

const TypeRow* row_of(DelrayDataType type) {
  const auto* const found = std::ranges::find(kTypes, type, &TypeRow::type);
  return found == std::end(kTypes) ? nullptr : found;
}

struct SubtypeRow {
  DelrayDataType kind;
  std::string_view name;
};
constexpr SubtypeRow kSubtypes[] = {
    {DELRAY_CAMERA, "perspective"},
    {DELRAY_CAMERA, "orthographic"},
    {DELRAY_GEOMETRY, "triangle"},
    {DELRAY_GEOMETRY, "sphere"},
    {DELRAY_LIGHT, "directional"},
    {DELRAY_LIGHT, "point"},
    {DELRAY_LIGHT, "quad"},
    {DELRAY_MATERIAL, "matte"},
    {DELRAY_MATERIAL, "physicallyBased"},
    {DELRAY_RENDERER, "default"},
    {DELRAY_RENDERER, "raytrace"},
    {DELRAY_SAMPLER, "image2D"},
    {DELRAY_INSTANCE, "transform"},
    {DELRAY_SURFACE, ""},
    {DELRAY_GROUP, ""},
    {DELRAY_WORLD, ""},
    {DELRAY_FRAME, ""},
};

// Scenes are made of it.
bool is_of_scenes(DelrayDataType kind) {
  return kind != DELRAY_CAMERA && kind != DELRAY_RENDERER && kind != DELRAY_FRAME;
}

const ParameterRow* parameter_of(const DelrayObject_& object, std::string_view name) {
  const std::string padded = " " + object.subtype + " ";
  for (const ParameterRow& row : parameter_rows()) {
    if (row.kind == object.kind && row.name == name &&
        (row.subtypes.empty() || row.subtypes.find(padded) != std::string_view::npos)) {
      return &row;
    }
  }
  return nullptr;
}

Value value_of(DelrayObject object, const ParameterRow& row, DelrayDataType type,
               const void* memory) {
  if (std::ranges::find(row.types, type) == row.types.end()) {
    std::string wanted;
    for (const DelrayDataType one : row.types)
      wanted += (wanted.empty() ? "" : ", ") + name_of(one);
    throw std::invalid_argument("parameter '" + std::string(row.name) + "' is of type " + wanted +
                                ", not " + name_of(type));
  }
  require(memory, "memory");
  Value value;
  value.type = type;
  if (type == DELRAY_STRING) {
    const auto* const text = static_cast<const char*>(memory);
    value.bytes.resize(std::strlen(text));
    std::memcpy(value.bytes.data(), text, value.bytes.size());
  } else if (is_object(type)) {
    DelrayObject other = nullptr;
    std::memcpy(static_cast<void*>(&other), memory, sizeof(other));
    require(other, row.name.data());
    if (other->kind != type || other->device != object->device)
      throw std::invalid_argument("parameter '" + std::string(row.name) + "': the handle is no " +
                                  name_of(type) + " of this device");
    value.object = Ref(other);
  } else {
    value.bytes.resize(size_of(type));
    std::memcpy(value.bytes.data(), memory, value.bytes.size());
  }
  return value;
}

DelrayObject new_object(DelrayDevice device, DelrayDataType kind, const char* subtype) {
  return guarded_value([&]() -> DelrayObject {
    require(device, "device");
    require(subtype, "subtype");
    const std::scoped_lock lock(device->mutex);
    if (!has_subtype(kind, subtype)) {
      throw std::invalid_argument(name_of(kind) + " has no subtype '" + subtype + "'; there are " +
                                  subtypes_of(kind));
    }
    return new DelrayObject_(device, kind, subtype);
  });
}

DelrayObject new_array(DelrayDevice device, DelrayDataType kind, const void* app_memory,
                       DelrayMemoryDeleter deleter, const void* user_data, DelrayDataType type,
                       std::uint64_t items1, std::uint64_t items2) {
  return guarded_value([&]() -> DelrayObject {
    require(device, "device");
    const std::size_t size = size_of(type);
    if (size == 0) throw std::invalid_argument("an array cannot hold " + name_of(type));
    constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
    if (items1 > kMost || (items2 != 0 && items1 > kMost / items2))
      throw std::invalid_argument("more items than memory can hold");
    if (app_memory == nullptr && deleter != nullptr)
      throw std::invalid_argument("a deleter without memory to delete");
    const std::scoped_lock lock(device->mutex);
    auto array = std::make_unique<DelrayObject_>(device, kind, "");
    array->item_type = type;
    array->items[0] = items1;
    array->items[1] = items2;
    if (app_memory == nullptr) {
      array->own_memory.resize(size * items1 * items2);
      array->memory = array->own_memory.data();
    } else {
      array->memory = app_memory;
    }
    if (app_memory != nullptr) keep_items(*array);
    array->deleter = deleter;  // last: what failed is still the caller's
    array->user_data = user_data;
    return array.release();
  });
}

}  // namespace

void keep_items(DelrayObject_& array) {
  if (!is_object(array.item_type)) return;
  std::vector<Ref> kept;
  const auto* const handles = static_cast<const DelrayObject*>(array.memory);
  for (std::uint64_t i = 0; i < array.items[0] * array.items[1]; ++i) {
    require(handles[i], "a handle in the array");
    if (handles[i]->kind != array.item_type || handles[i]->device != array.device)
      throw std::invalid_argument("item " + std::to_string(i) + " is no " +
                                  name_of(array.item_type) + " of this device");
    kept.emplace_back(handles[i]);
  }
  array.item_objects = std::move(kept);
}

void retain(DelrayDevice device) { device->references.fetch_add(1); }
void release(DelrayDevice device) {
  if (device->references.fetch_sub(1) == 1) delete device;
}
void retain(DelrayObject object) { object->references.fetch_add(1); }
void release(DelrayObject object) {
  if (object->references.fetch_sub(1) == 1) delete object;
}

std::size_t size_of(DelrayDataType type) {
  const TypeRow* const row = row_of(type);
  return row == nullptr ? 0 : row->size;
}
bool is_object(DelrayDataType type) { return type >= DELRAY_ARRAY1D && row_of(type) != nullptr; }
std::string name_of(DelrayDataType type) {
  const TypeRow* const row = row_of(type);
  return row == nullptr ? "unknown type " + std::to_string(static_cast<int>(type)) : row->name;
}

bool has_subtype(DelrayDataType kind, std::string_view subtype) {
  return std::ranges::any_of(
      kSubtypes, [&](const SubtypeRow& row) { return row.kind == kind && row.name == subtype; });
}

std::string subtypes_of(DelrayDataType kind) {
  std::string names;
  for (const SubtypeRow& row : kSubtypes) {
    if (row.kind == kind) names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  return names;
}

}  // namespace delray::c

DelrayObject_::DelrayObject_(DelrayDevice of, DelrayDataType what, std::string which)
    : device(of), kind(what), subtype(std::move(which)) {
  delray::c::retain(device);
  if (kind == DELRAY_FRAME) frame = std::make_unique<delray::c::FrameState>();
}

DelrayObject_::~DelrayObject_() {
  if (deleter != nullptr) deleter(user_data, memory);
  pending.clear();
  committed.clear();
  item_objects.clear();
  frame.reset();
  delray::c::release(device);
}

std::string DelrayObject_::text(std::string_view name, std::string_view otherwise) const {
  const delray::c::Value* const found = find(name);
  if (found == nullptr || found->type != DELRAY_STRING) return std::string(otherwise);
  return {reinterpret_cast<const char*>(found->bytes.data()), found->bytes.size()};
}

using delray::c::guarded;
using delray::c::guarded_value;
using delray::c::new_object;
using delray::c::require;

namespace {

// f with the device's turn, of an object of it.
template <class F>
DelrayStatus with(DelrayDevice device, DelrayObject object, F&& f) {
  return guarded([&] {
    require(device, "device");
    require(object, "object");
    const std::scoped_lock lock(device->mutex);
    if (object->device != device) throw std::invalid_argument("the object is another device's");
    f();
  });
}

}  // namespace

extern "C" {

DelrayDevice delrayNewDevice(int threads) {
  return guarded_value([&]() -> DelrayDevice {
    constexpr int kMostThreads = 4096;
    if (threads < 0 || threads > kMostThreads)
      throw std::invalid_argument("threads: " + std::to_string(threads) + " is not from 0 to " +
                                  std::to_string(kMostThreads));
    auto device = std::make_unique<DelrayDevice_>();
    device->threads =
        threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return device.release();
  });
}

void delrayReleaseDevice(DelrayDevice device) {
  if (device != nullptr) delray::c::release(device);
}

DelrayArray1D delrayNewArray1D(DelrayDevice device, const void* app_memory,
                               DelrayMemoryDeleter deleter, const void* user_data,
                               DelrayDataType type, uint64_t items) {
  return delray::c::new_array(device, DELRAY_ARRAY1D, app_memory, deleter, user_data, type, items,
                              1);
}

DelrayArray2D delrayNewArray2D(DelrayDevice device, const void* app_memory,
                               DelrayMemoryDeleter deleter, const void* user_data,
                               DelrayDataType type, uint64_t items1, uint64_t items2) {
  return delray::c::new_array(device, DELRAY_ARRAY2D, app_memory, deleter, user_data, type, items1,
                              items2);
}

void* delrayMapArray(DelrayDevice device, DelrayObject array) {
  void* mapped = nullptr;
  with(device, array, [&] {
    if (array->memory == nullptr) throw std::invalid_argument("the object is no array with items");
    array->is_mapped = true;
    mapped = const_cast<void*>(array->memory);
  });
  return mapped;
}

DelrayStatus delrayUnmapArray(DelrayDevice device, DelrayObject array) {
  return with(device, array, [&] {
    if (!array->is_mapped) throw std::invalid_argument("the object is no array that is mapped");
    array->is_mapped = false;
    ++device->scene_changes;
    delray::c::keep_items(*array);
  });
}

DelrayCamera delrayNewCamera(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_CAMERA, subtype);
}
DelrayGeometry delrayNewGeometry(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_GEOMETRY, subtype);
}
DelrayLight delrayNewLight(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_LIGHT, subtype);
}
DelrayMaterial delrayNewMaterial(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_MATERIAL, subtype);
}
DelrayRenderer delrayNewRenderer(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_RENDERER, subtype);
}
DelraySampler delrayNewSampler(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_SAMPLER, subtype);
}
DelraySurface delrayNewSurface(DelrayDevice device) {
  return new_object(device, DELRAY_SURFACE, "");
}
DelrayGroup delrayNewGroup(DelrayDevice device) { return new_object(device, DELRAY_GROUP, ""); }
DelrayInstance delrayNewInstance(DelrayDevice device, const char* subtype) {
  return new_object(device, DELRAY_INSTANCE, subtype);
}
DelrayWorld delrayNewWorld(DelrayDevice device) { return new_object(device, DELRAY_WORLD, ""); }
DelrayFrame delrayNewFrame(DelrayDevice device) { return new_object(device, DELRAY_FRAME, ""); }

DelrayStatus delraySetParameter(DelrayDevice device, DelrayObject object, const char* name,
                                DelrayDataType type, const void* memory) {
  return with(device, object, [&] {
    require(name, "name");
    const delray::c::ParameterRow* const row = delray::c::parameter_of(*object, name);
    if (row == nullptr) {
      throw std::invalid_argument(delray::c::name_of(object->kind) + " " + object->subtype +
                                  " has no parameter '" + name + "'");
    }
    object->pending[name] = delray::c::value_of(object, *row, type, memory);
  });
}

DelrayStatus delrayUnsetParameter(DelrayDevice device, DelrayObject object, const char* name) {
  return with(device, object, [&] {
    require(name, "name");
    object->pending.erase(name);
  });
}

DelrayStatus delrayUnsetAllParameters(DelrayDevice device, DelrayObject object) {
  return with(device, object, [&] { object->pending.clear(); });
}

DelrayStatus delrayCommitParameters(DelrayDevice device, DelrayObject object) {
  return with(device, object, [&] {
    object->committed = object->pending;
    if (delray::c::is_of_scenes(object->kind)) ++device->scene_changes;
  });
}

void delrayRetain(DelrayDevice device, DelrayObject object) {
  with(device, object, [&] { delray::c::retain(object); });
}

void delrayRelease(DelrayDevice device, DelrayObject object) {
  if (device == nullptr || object == nullptr) return;
  delray::c::retain(device);  // for the lock, should the object be the last that has it
  {
    const std::scoped_lock lock(device->mutex);
    delray::c::release(object);
  }
  delray::c::release(device);
}

}  // extern "C"
