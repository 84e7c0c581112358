// Boost.Beast, one call after the other; a read that takes too long ends the connection.
#include "tests/apps/view/page_client.h"

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <chrono>
#include <cstring>
#include <stdexcept>

namespace delray::tests {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;

constexpr std::chrono::seconds kPatience{60};  // machines may be slow; nothing waits so long

tcp::endpoint endpoint_of(const Address& address) {
  return {asio::ip::make_address(address.host), address.port};
}

std::string host_of(const Address& address) {
  return address.host + ":" + std::to_string(address.port);
}

}  // namespace

Address parse_address(const std::string& url) {
  const std::size_t host = url.find("//") + 2, port = url.find(':', host) + 1,
                    path = url.find('/', port), token = url.find("token=") + 6;
  Address address;
  address.host = url.substr(host, port - host - 1);
  address.port = static_cast<std::uint16_t>(std::stoi(url.substr(port, path - port)));
  address.token = url.substr(token, url.find_first_of("\r\n", token) - token);
  return address;
}

HttpAnswer get(const Address& address, const std::string& target, const std::string& host) {
  asio::io_context context;
  tcp::socket socket(context);
  socket.connect(endpoint_of(address));
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, host.empty() ? host_of(address) : host);
  boost::system::error_code error;
  http::write(socket, request, error);
  beast::flat_buffer buffer;
  http::response<http::string_body> answer;
  http::read(socket, buffer, answer, error);
  if (error) return {};
  const auto policy = answer["Content-Security-Policy"];
  return {static_cast<int>(answer.result_int()), answer.body(),
          std::string(policy.data(), policy.size())};
}

struct PageClient::Socket {
  asio::io_context context;
  websocket::stream<beast::tcp_stream> stream{context};

  // Runs what was begun until it is done, or too late.
  void finish() {
    context.restart();
    context.run();
  }
};

PageClient::PageClient(const Address& address, const std::string& origin, const std::string& target)
    : socket_(std::make_unique<Socket>()) {
  beast::get_lowest_layer(socket_->stream).connect(endpoint_of(address));
  socket_->stream.set_option(
      websocket::stream_base::decorator([&](websocket::request_type& request) {
        request.set(http::field::origin, origin.empty() ? "http://" + host_of(address) : origin);
      }));
  boost::system::error_code error;
  socket_->stream.handshake(host_of(address),
                            target.empty() ? "/socket?token=" + address.token : target, error);
  if (error) throw std::runtime_error("refused: " + error.message());
  socket_->stream.read_message_max(std::size_t{1} << 28);
}
PageClient::~PageClient() = default;

void PageClient::say(const nlohmann::json& message) { say_text(message.dump()); }

void PageClient::say_text(const std::string& text) {
  socket_->stream.text(true);
  boost::system::error_code error;
  socket_->stream.write(asio::buffer(text), error);
  if (error) throw std::runtime_error("cannot say: " + error.message());
}

PageClient::Message PageClient::read() {
  beast::flat_buffer buffer;
  boost::system::error_code result = asio::error::timed_out;
  beast::get_lowest_layer(socket_->stream).expires_after(kPatience);
  socket_->stream.async_read(
      buffer, [&](const boost::system::error_code& error, std::size_t) { result = error; });
  socket_->finish();
  beast::get_lowest_layer(socket_->stream).expires_never();
  if (result) throw std::runtime_error("no message: " + result.message());
  return {socket_->stream.got_text(), beast::buffers_to_string(buffer.data())};
}

PageFrame PageClient::frame_of(const Message& message) {
  PageFrame frame;
  frame.bytes = message.bytes.size();
  std::uint32_t length = 0;
  std::memcpy(&length, message.bytes.data(), sizeof length);
  frame.header = nlohmann::json::parse(message.bytes.substr(sizeof length, length));
  const std::string file = message.bytes.substr(sizeof length + length);
  frame.file.resize(file.size());
  std::memcpy(frame.file.data(), file.data(), file.size());
  if (acknowledges_) say({{"type", "seen"}, {"frame", frame.header["frame"]}});
  return frame;
}

nlohmann::json PageClient::text_of(const Message& message) const {
  nlohmann::json json = nlohmann::json::parse(message.bytes);
  if (see_) see_(json);
  return json;
}

nlohmann::json PageClient::wait_for(const std::string& type) {
  for (;;) {
    const Message message = read();
    if (!message.is_text) {
      frame_of(message);
      continue;
    }
    nlohmann::json json = text_of(message);
    if (json["type"] == type) return json;
  }
}

PageFrame PageClient::wait_for_frame(const std::function<bool(const nlohmann::json&)>& is_it) {
  for (;;) {
    const Message message = read();
    if (message.is_text) {
      text_of(message);
      continue;
    }
    PageFrame frame = frame_of(message);
    if (is_it(frame.header)) return frame;
  }
}

std::string PageClient::reason_of_end() {
  constexpr int kMost = 2000;
  try {
    for (int i = 0; i < kMost; ++i) read();
  } catch (const std::runtime_error&) {
    const auto& reason = socket_->stream.reason().reason;
    return "ended: " + std::string(reason.data(), reason.size());
  }
  return "not ended";
}

}  // namespace delray::tests
