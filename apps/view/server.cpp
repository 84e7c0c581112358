// Boost.Beast over Asio with a single thread: nothing here needs a lock, and what others want is
// posted to it. Headers of 1.74 and later.
#include "apps/view/server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <cerrno>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "apps/session.h"
#include "apps/view/message.h"
#include "files/error.h"

namespace delray::apps::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostConnections = 32;
constexpr std::uint32_t kLongestHeader = 8192;    // bytes
constexpr std::chrono::seconds kRequestTime{10};  // to ask, and to take the answer
constexpr std::chrono::milliseconds kRetry{100};  // when connections cannot be accepted
constexpr std::chrono::seconds kSilence{30};      // after which a page is not there any more
constexpr double kMessagesPerSecond = 400, kBurst = 400;  // a page sends at most some hundred
constexpr std::size_t kMostTextsWaiting = 256;            // for a page that takes none

// Takes as long whichever character differs.
bool is_token(std::string_view given, std::string_view token) {
  unsigned difference = given.size() == token.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |=
        static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i % token.size()]);
  return difference == 0;
}

// The path of a target, and whether its query is the token: "/?token=..."
struct Target {
  std::string path;
  bool has_token = false;
};
Target target_of(std::string_view text, std::string_view token) {
  constexpr std::string_view kKey = "?token=";
  const std::size_t query = std::min(text.find('?'), text.size());
  Target target{std::string(text.substr(0, query)), false};
  const std::string_view rest = text.substr(query);
  target.has_token = rest.starts_with(kKey) && is_token(rest.substr(kKey.size()), token);
  return target;
}

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

using Request = http::request<http::empty_body>;
using Answer = http::response<http::string_body>;

// Stands in the page for a number that is used once, which its script has and no other.
constexpr std::string_view kNonce = "NONCE";

// Only the answer that has a page has scripts.
Answer answer(const Request& request, http::status status, std::string body,
              const char* type = "text/plain; charset=utf-8", const std::string& nonce = "") {
  Answer result{status, request.version()};
  result.set(http::field::content_type, type);
  result.set(http::field::cache_control, "no-store");
  result.set("X-Content-Type-Options", "nosniff");
  result.set("X-Frame-Options", "DENY");
  result.set("Referrer-Policy", "no-referrer");
  result.set("Cross-Origin-Resource-Policy", "same-origin");
  result.set("Cross-Origin-Opener-Policy", "same-origin");
  // All of the page is in the page. Its styles may be written into elements, as charts are.
  result.set("Content-Security-Policy",
             fmt::format("default-src 'none'; script-src {}; style-src 'unsafe-inline'; img-src "
                         "blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                         "frame-ancestors 'none'",
                         nonce.empty() ? "'none'" : "'nonce-" + nonce + "'"));
  result.keep_alive(false);
  if (request.method() != http::verb::head) result.body() = std::move(body);
  result.prepare_payload();
  return result;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw files::FileError(files::Cause::device, "random numbers", "", "the system gives none");
  std::string text;
  for (const unsigned byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

bool is_own_host(const std::string& host, std::uint16_t port, bool only_this_machine) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string::npos || host.substr(colon + 1) != std::to_string(port)) return false;
  std::string name = host.substr(0, colon);
  if (name == "localhost") return true;
  if (name.size() > 2 && name.front() == '[' && name.back() == ']')
    name = name.substr(1, name.size() - 2);
  error_code error;
  const asio::ip::address address = asio::ip::make_address(name, error);
  return !error && (address.is_loopback() || !only_this_machine);
}

class Server::Listener {
 public:
  Listener(const ServerOptions& options, std::string page, ServerEvents events)
      : token_(options.token), page_(std::move(page)), events_(std::move(events)) {
    error_code error;
    const asio::ip::address address = asio::ip::make_address(options.address, error);
    if (error) throw UsageError(fmt::format("--bind: '{}' is no IP address", options.address));
    const tcp::endpoint endpoint(address, options.port);
    only_this_machine_ = address.is_loopback();
    try {
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
      endpoint_ = acceptor_.local_endpoint();
    } catch (const boost::system::system_error& failure) {
      throw files::FileError(files::Cause::device,
                             fmt::format("{}:{}", options.address, options.port), "",
                             "cannot listen here: " + failure.code().message());
    }
  }

  ~Listener() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
    connections_.clear();
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void start() {
    accept();
    thread_ = std::jthread([this] { context_.run(); });
  }

  std::uint16_t port() const { return endpoint_.port(); }
  std::string url() const {
    const asio::ip::address address = endpoint_.address();
    std::string host = address.to_string();
    if (address.is_unspecified()) host = asio::ip::host_name();
    if (address.is_v6() && !address.is_unspecified()) host = "[" + host + "]";
    return fmt::format("http://{}:{}/?token={}", host, port(), token_);
  }

  // Calls f(connection) in the server's thread, where the page is there; what was asked for first
  // first, whichever threads asked.
  template <class F>
  void with(PageId page, F&& f) {
    asio::post(in_order_, [this, page, f = std::forward<F>(f)]() mutable {
      const auto found = connections_.find(page);
      if (found != connections_.end()) f(*found->second);
    });
  }

  class Connection;

 private:
  class Asked;

  void accept();

  bool is_trusted(const Request& request) const {
    const std::string host = text_of(request[http::field::host]);
    // Behind an address of all interfaces a page may have been opened by the machine's own name.
    const bool is_own_name =
        !only_this_machine_ && host == fmt::format("{}:{}", asio::ip::host_name(), port());
    return is_own_name || is_own_host(host, port(), only_this_machine_);
  }

  Answer answer_to(const Request& request) const {
    if (!is_trusted(request))
      return answer(request, http::status::forbidden, "This is not the host of that name.\n");
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return answer(request, http::status::method_not_allowed, "GET only.\n");
    const Target target = target_of(text_of(request.target()), token_);
    if (!target.has_token) {
      return answer(request, http::status::forbidden,
                    "Use the address that delray view has printed: its token is missing here, or "
                    "is that of an earlier run.\n");
    }
    if (target.path != "/") return answer(request, http::status::not_found, "Nothing is here.\n");
    const std::string nonce = random_token();
    std::string page = page_;
    for (std::size_t at = page.find(kNonce); at != std::string::npos; at = page.find(kNonce, at))
      page.replace(at, kNonce.size(), nonce);
    return answer(request, http::status::ok, std::move(page), "text/html; charset=utf-8", nonce);
  }

  bool may_open(const Request& request) const {
    const Target target = target_of(text_of(request.target()), token_);
    return is_trusted(request) && target.has_token && target.path == "/socket" &&
           text_of(request[http::field::origin]) == "http://" + text_of(request[http::field::host]);
  }

  std::size_t asked_ = 0;  // requests that are not answered yet; they outlive what is below
  std::string token_, page_;
  ServerEvents events_;
  asio::io_context context_{1};
  // What the thread itself posts to a context comes after what others post meanwhile.
  asio::strand<asio::io_context::executor_type> in_order_{context_.get_executor()};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer retry_{context_};
  tcp::endpoint endpoint_;
  bool only_this_machine_ = true;
  PageId next_ = 1;
  std::map<PageId, std::shared_ptr<Connection>> connections_;
  std::jthread thread_;
};

// A page's WebSocket: one write at a time, texts before frames.
class Server::Listener::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Listener& listener, PageId id, beast::tcp_stream&& stream)
      : listener_(listener), id_(id), socket_(std::move(stream)) {}

  void open(const Request& request) {
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(websocket::stream_base::timeout{kRequestTime, kSilence, true});
    socket_.read_message_max(kLongestMessage);
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true), ignored);
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return self->end();
      self->is_open_ = true;
      self->listener_.events_.opened(self->id_);
      self->read();
      self->write();
    });
  }

  void send(std::string&& text) {
    if (texts_.size() >= kMostTextsWaiting) return end();
    texts_.push_back(std::move(text));
    write();
  }
  void send_frame(std::uint64_t number, std::vector<std::byte>&& frame) {
    if (number < newest_) return;
    newest_ = number;
    frame_ = std::move(frame);
    write();
  }
  void close(const std::string& why) {
    if (is_closing_) return;
    is_closing_ = true;
    websocket::close_reason reason(websocket::close_code::policy_error);
    reason.reason.assign(why.substr(0, std::min<std::size_t>(why.size(), 120)));
    socket_.async_close(reason, [self = shared_from_this()](const error_code&) { self->end(); });
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error) return self->end();
      if (!self->socket_.got_text()) return self->close("text only");
      if (!self->takes_message()) return self->close("too many messages");
      std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (!self->is_closing_) self->listener_.events_.received(self->id_, std::move(text));
      self->read();
    });
  }

  // A bucket that fills up by so many a second.
  bool takes_message() {
    const auto now = std::chrono::steady_clock::now();
    allowance_ =
        std::min(kBurst, allowance_ + kMessagesPerSecond *
                                          std::chrono::duration<double>(now - last_).count());
    last_ = now;
    allowance_ -= 1;
    return allowance_ >= 0;
  }

  void write() {
    if (!is_open_ || is_writing_ || is_closing_) return;
    const bool is_text = !texts_.empty();
    if (!is_text && !frame_) return;
    is_writing_ = true;
    if (is_text) {
      text_ = std::move(texts_.front());
      texts_.pop_front();
    } else {
      bytes_ = *std::exchange(frame_, std::nullopt);
    }
    socket_.text(is_text);
    const asio::const_buffer what =
        is_text ? asio::buffer(text_) : asio::buffer(bytes_.data(), bytes_.size());
    socket_.async_write(what, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->is_writing_ = false;
      if (error) return self->end();
      self->write();
    });
  }

  // Once; whatever still waits for something is told that there is nothing any more.
  void end() {
    if (is_over_) return;
    is_over_ = true;
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    if (is_open_) listener_.events_.closed(id_);
    listener_.connections_.erase(id_);
  }

  Listener& listener_;
  PageId id_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::deque<std::string> texts_;
  std::optional<std::vector<std::byte>> frame_;
  std::uint64_t newest_ = 0;
  std::string text_;              // that is being written
  std::vector<std::byte> bytes_;  // likewise
  double allowance_ = kBurst;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  bool is_open_ = false, is_writing_ = false, is_closing_ = false, is_over_ = false;
};

// A request that has come in.
class Server::Listener::Asked : public std::enable_shared_from_this<Asked> {
 public:
  Asked(Listener& listener, tcp::socket&& socket)
      : listener_(listener), stream_(std::move(socket)) {
    ++listener_.asked_;
    parser_.header_limit(kLongestHeader);
    parser_.body_limit(0);
  }
  ~Asked() { --listener_.asked_; }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  void read() {
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       if (!error) self->answer_it();
                     });
  }

 private:
  void answer_it() {
    const Request& request = parser_.get();
    if (websocket::is_upgrade(request) && listener_.may_open(request)) {
      const PageId id = listener_.next_++;
      const auto connection = std::make_shared<Connection>(listener_, id, std::move(stream_));
      listener_.connections_.emplace(id, connection);
      connection->open(request);
      return;
    }
    answer_ = listener_.answer_to(request);
    stream_.expires_after(kRequestTime);
    http::async_write(stream_, answer_,
                      [self = shared_from_this()](const error_code&, std::size_t) {
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  Listener& listener_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLongestHeader};
  http::request_parser<http::empty_body> parser_;
  Answer answer_;
};

void Server::Listener::accept() {
  acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
    if (!error && connections_.size() + asked_ < kMostConnections)
      std::make_shared<Asked>(*this, std::move(socket))->read();
    if (!error) return accept();
    if (error == asio::error::operation_aborted) return;
    retry_.expires_after(kRetry);  // the process has no descriptors left, as it may be
    retry_.async_wait([this](const error_code& stopped) {
      if (!stopped) accept();
    });
  });
}

Server::Server(const ServerOptions& options, std::string page, ServerEvents events)
    : listener_(std::make_unique<Listener>(options, std::move(page), std::move(events))) {}
Server::~Server() = default;

void Server::start() { listener_->start(); }
std::uint16_t Server::port() const { return listener_->port(); }
std::string Server::url() const { return listener_->url(); }

void Server::send(PageId page, std::string text) {
  listener_->with(page, [text = std::move(text)](Listener::Connection& connection) mutable {
    connection.send(std::move(text));
  });
}

void Server::send_frame(PageId page, std::uint64_t number, std::vector<std::byte>&& frame) {
  listener_->with(page,
                  [number, frame = std::move(frame)](Listener::Connection& connection) mutable {
                    connection.send_frame(number, std::move(frame));
                  });
}

void Server::close(PageId page, const std::string& why) {
  listener_->with(page, [why](Listener::Connection& connection) { connection.close(why); });
}

}  // namespace delray::apps::view
