// Starts Embree, counts the memory that it takes, and finds out how wide its packets are.
#include <new>
#include <stdexcept>

#include "raytrace/scene/embree_objects.h"

namespace delray::raytrace {
namespace {

bool count_memory(void* total, ssize_t bytes, bool /*after*/) {
  static_cast<std::atomic<std::int64_t>*>(total)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

int widest_packet(RTCDevice device) {
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) return 16;
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) return 8;
  return 4;
}

std::string isa_in_use(int widest_packet) {
#if defined(__x86_64__)
  if (widest_packet == 16) return "avx512";
  if (widest_packet == 8) return __builtin_cpu_supports("avx2") != 0 ? "avx2" : "avx";
  return __builtin_cpu_supports("sse4.2") != 0 ? "sse4.2" : "sse2";
#else
  (void)widest_packet;
  return "neon";
#endif
}

}  // namespace

void check(RTCDevice device, const char* doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(std::string("Embree failed with error ") +
                           std::to_string(static_cast<int>(error)) + " while " + doing);
}

EmbreeDevice::EmbreeDevice(const BuildOptions& options) : state_(std::make_shared<State>()) {
  // No "threads=": with oneTBB that would limit every arena of the process.
  std::string configuration = "set_affinity=0";
  if (!options.isa.empty()) configuration += ",isa=" + options.isa;
  state_->device.reset(rtcNewDevice(configuration.c_str()));
  if (!state_->device) check(nullptr, "starting");
  RTCDevice device = state_->device.get();
  rtcSetDeviceMemoryMonitorFunction(device, count_memory, &state_->memory);
  state_->widest_packet = widest_packet(device);
  state_->isa = isa_in_use(state_->widest_packet);
}

std::uint64_t EmbreeDevice::memory() const {
  return static_cast<std::uint64_t>(state_->memory.load(std::memory_order_relaxed));
}

std::string EmbreeDevice::version() const {
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(state_->device.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
         "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

std::string EmbreeDevice::isa() const { return state_->isa; }

}  // namespace delray::raytrace
