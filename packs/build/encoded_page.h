// A page that is only to be written.
#pragma once

#include <vector>

#include "packs/page.h"

namespace delray::packs::internal {

// Its row lacks the place in the file.
struct EncodedPage {
  PageRow row;
  std::vector<char> bytes;
};

// What `row` says already stays: first, level and groups.
EncodedPage encode_page(const Page& page, PageRow row);

}  // namespace delray::packs::internal
