// Reads the GNU build id notes of the program and of its libdelray libraries from their headers in
// memory.
#include "apps/build_id.h"

#include <link.h>

#include <cstddef>
#include <cstring>
#include <string_view>

namespace delray::apps {
namespace {

// Appends the build id of a loaded object, which is a note of its program header.
void append_build_id(const dl_phdr_info& object, std::string& text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  constexpr std::size_t kAlignment = 4;
  const auto padded = [](std::size_t size) { return (size + kAlignment - 1) & ~(kAlignment - 1); };
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const char* at = reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr);
    const char* const end = at + segment.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const char* const name = at + sizeof note;
      const char* const id = name + padded(note.n_namesz);
      if (note.n_type == NT_GNU_BUILD_ID && std::string_view(name, 3) == "GNU") {
        for (std::size_t k = 0; k < note.n_descsz; ++k) {
          const auto byte = static_cast<unsigned char>(id[k]);
          text += kDigits[byte >> 4];
          text += kDigits[byte & 15];
        }
      }
      at = id + padded(note.n_descsz);
    }
  }
}

int look_at(dl_phdr_info* object, std::size_t /*size*/, void* text) {
  const std::string_view path = object->dlpi_name;
  const std::string_view name = path.substr(path.rfind('/') + 1);
  if (path.empty() || name.starts_with("libdelray"))  // the program itself has no path
    append_build_id(*object, *static_cast<std::string*>(text));
  return 0;
}

}  // namespace

std::string build_id() {
  std::string text;
  dl_iterate_phdr(look_at, &text);
  return text.empty() ? "unknown" : text;
}

}  // namespace delray::apps
