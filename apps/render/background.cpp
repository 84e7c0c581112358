// Names of backgrounds, and colours by hexadecimal digits.
#include "apps/render/background.h"

#include <charconv>

#include "apps/options/list.h"
#include "image/srgb.h"

namespace delray::apps {
namespace {

struct NamedKind {
  const char* name;
  Background::Kind kind;
};
constexpr NamedKind kNamedBackgrounds[] = {{"auto", Background::Kind::automatic},
                                           {"environment", Background::Kind::environment},
                                           {"studio", Background::Kind::studio},
                                           {"transparent", Background::Kind::transparent}};

}  // namespace

std::vector<std::string> background_names() { return names_in(kNamedBackgrounds); }

Background parse_background(const std::string& text) {
  for (const NamedKind& named : kNamedBackgrounds) {
    if (text == named.name) return {named.kind, {}};
  }
  unsigned code = 0;
  const char* const begin = text.data() + 1;
  const char* const end = text.data() + text.size();
  if (text.size() == 7 && text[0] == '#' && std::from_chars(begin, end, code, 16).ptr == end) {
    const auto channel = [code](int shift) {
      return image::decode_srgb(static_cast<std::uint8_t>(code >> shift));
    };
    return {Background::Kind::colour, {channel(16), channel(8), channel(0), 1.0F}};
  }
  std::vector<std::string> legal = background_names();
  legal.emplace_back("#rrggbb");
  throw UsageError("--background: " + is_not_one_of(text, legal));
}

}  // namespace delray::apps
