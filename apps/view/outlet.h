// The way to pages, for who need not know how they are connected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace delray::apps::view {

// A page that is connected; no number is used twice.
using PageId = std::uint64_t;

// Calls return at once and may come from any thread. Pages that are not there any more are passed
// over.
class Outlet {
 public:
  virtual ~Outlet() = default;
  // Texts arrive in their order, none is lost.
  virtual void send(PageId page, std::string text) = 0;
  // Of frames that the page has no time for only the one with the greatest number is kept; one
  // that is older than what was sent is dropped.
  virtual void send_frame(PageId page, std::uint64_t number, std::vector<std::byte>&& frame) = 0;
  // Ends the connection, saying why.
  virtual void close(PageId page, const std::string& why) = 0;
};

}  // namespace delray::apps::view
