// A web server for one page and the WebSockets that it opens. Knows nothing of what is shown.
//
// Only who knows the token gets anything. Host and Origin are checked, so that no other site's page
// can talk to it through the user's browser, by a name of its own that leads here either. Requests,
// messages, their rate, connections and what waits to be sent are limited.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "apps/view/outlet.h"

namespace delray::apps::view {

struct ServerOptions {
  std::string address = "127.0.0.1";  // of an interface of this machine
  std::uint16_t port = 0;             // 0: any that is free
  std::string token;                  // letters and digits
};

// What happens to connections; called by the server's own thread, one after the other.
struct ServerEvents {
  std::function<void(PageId)> opened;
  std::function<void(PageId, std::string&& text)> received;
  std::function<void(PageId)> closed;
};

// 128 random bits as text, from the system.
std::string random_token();

// Whether the Host of a request is this server: its port, and localhost or an address, not a name,
// which could be anybody's. An address that is not of this machine alone is taken only where the
// server listens to others.
bool is_own_host(const std::string& host, std::uint16_t port, bool only_this_machine);

class Server final : public Outlet {
 public:
  // Throws UsageError for an address that is none, files::FileError (device) where it cannot be
  // listened at.
  Server(const ServerOptions& options, std::string page, ServerEvents events);
  ~Server() override;
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Answers from now on. Once.
  void start();

  std::uint16_t port() const;
  std::string url() const;  // with the token

  void send(PageId page, std::string text) override;
  void send_frame(PageId page, std::uint64_t number, std::vector<std::byte>&& frame) override;
  void close(PageId page, const std::string& why) override;

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace delray::apps::view
