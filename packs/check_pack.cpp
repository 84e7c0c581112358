// Pages in runs, each read by some thread; of what fails in a run the lowest page is told.
// O(bytes).
#include "packs/check_pack.h"

#include <algorithm>
#include <exception>
#include <vector>

#include "files/error.h"
#include "packs/format/trailer.h"
#include "parallel/parallel_for.h"

namespace delray::packs {
namespace {

constexpr std::size_t kPagesCheckedAtOnce = 1024;

}  // namespace

void check_pack(const PackReader& pack, parallel::Progress* progress) {
  const std::size_t pages = pack.pages().size();
  if (progress != nullptr) progress->start(pages);
  std::uint64_t end = internal::kHeaderBytes;
  std::vector<std::exception_ptr> failures(std::min(kPagesCheckedAtOnce, pages));
  for (std::size_t first = 0; first < pages; first += kPagesCheckedAtOnce) {
    const std::size_t count = std::min(kPagesCheckedAtOnce, pages - first);
    parallel::parallel_for(0, count, 1, [&](std::size_t i) {
      try {
        pack.read(static_cast<std::uint32_t>(first + i));
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      if (failures[i]) std::rethrow_exception(failures[i]);
      const PageRow& row = pack.pages()[first + i];
      if (row.offset != end) {
        throw files::FileError(files::Cause::input, pack.name(),
                               "page " + std::to_string(first + i),
                               "does not begin where the one before it ends");
      }
      end += row.bytes;
    }
    if (progress != nullptr) progress->advance(count);
  }
}

}  // namespace delray::packs
