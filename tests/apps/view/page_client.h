// A page without a browser: a WebSocket client that a test tells what to say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace delray::tests {

struct Address {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
  std::string token;
};
// Of "http://host:port/?token=...".
Address parse_address(const std::string& url);

// The status of a request, 0 where the connection ends without one, and its body.
struct HttpAnswer {
  int status = 0;
  std::string body, policy;
};
HttpAnswer get(const Address& address, const std::string& target, const std::string& host);

// A frame as it came.
struct PageFrame {
  nlohmann::json header;
  std::vector<std::byte> file;
  std::size_t bytes = 0;
};

// Connects, or throws std::runtime_error where that is refused.
class PageClient {
 public:
  explicit PageClient(const Address& address, const std::string& origin = "",
                      const std::string& target = "");
  ~PageClient();

  void say(const nlohmann::json& message);
  void say_text(const std::string& text);
  // Reads until `is_it` takes a text message, which is returned; frames are acknowledged and kept
  // as the last. Throws std::runtime_error after 20 seconds, or when the connection ends.
  nlohmann::json wait_for(const std::string& type);
  // Whoever waits shows all text messages to `see`.
  void watch(std::function<void(const nlohmann::json& message)> see) { see_ = std::move(see); }
  // The first frame for which `is_it` holds.
  PageFrame wait_for_frame(const std::function<bool(const nlohmann::json& header)>& is_it);
  // Whether the server ends the connection before so many messages; its reason.
  std::string reason_of_end();
  void acknowledge(bool on) { acknowledges_ = on; }

 private:
  struct Socket;
  struct Message {
    bool is_text = true;
    std::string bytes;
  };
  Message read();
  PageFrame frame_of(const Message& message);
  nlohmann::json text_of(const Message& message) const;

  std::unique_ptr<Socket> socket_;
  std::function<void(const nlohmann::json& message)> see_;
  bool acknowledges_ = true;
};

}  // namespace delray::tests
