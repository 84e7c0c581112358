#include "apps/view/server.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/session.h"
#include "apps/view/page.h"
#include "files/error.h"
#include "tests/apps/view/page_client.h"

namespace delray::apps::view {
namespace {

using tests::Address;
using tests::PageClient;

// A server that notes what happens.
class Noted {
 public:
  explicit Noted(std::string page = "<script nonce=\"NONCE\"></script>")
      : server_({.token = "0123456789abcdef"}, std::move(page),
                {[this](PageId id) { note("opened " + std::to_string(id)); },
                 [this](PageId, std::string&& text) { note(text); },
                 [this](PageId id) { note("closed " + std::to_string(id)); }}) {
    server_.start();
  }
  Server& server() { return server_; }
  Address address() const { return tests::parse_address(server_.url()); }
  std::string next() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(60), [&] { return !notes_.empty(); });
    if (notes_.empty()) return "nothing";
    std::string first = notes_.front();
    notes_.pop_front();
    return first;
  }

 private:
  void note(const std::string& text) {
    const std::scoped_lock lock(mutex_);
    notes_.push_back(text);
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> notes_;
  Server server_;
};

TEST(ViewServer, TokensAreLongAndNew) {
  const std::string a = random_token(), b = random_token();
  EXPECT_EQ(a.size(), 32U);
  EXPECT_NE(a, b);
}

TEST(ViewServer, GivesThePageToWhoHasTheToken) {
  Noted noted;
  const Address address = noted.address();
  const auto page = tests::get(address, "/?token=" + address.token, "");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body.find("NONCE"), std::string::npos);
  const std::string nonce = page.body.substr(15, 32);
  EXPECT_NE(page.policy.find("script-src 'nonce-" + nonce + "'"), std::string::npos) << page.policy;
  EXPECT_NE(page.policy.find("default-src 'none'"), std::string::npos);
  for (const std::string target :
       {"/", "/?token=", "/?token=0123456789abcdee", "/?token=0123456789abcdeff", "/?token=0",
        "/?x=1&token=0123456789abcdef"}) {
    const auto refused = tests::get(address, target, "");
    EXPECT_EQ(refused.status, 403) << target;
    EXPECT_EQ(refused.body.find(address.token), std::string::npos);
  }
  EXPECT_EQ(tests::get(address, "/other?token=" + address.token, "").status, 404);
}

TEST(ViewServer, AnswersUnderItsOwnNameOnly) {
  Noted noted;
  const Address address = noted.address();
  const std::string target = "/?token=" + address.token, port = ":" + std::to_string(address.port);
  EXPECT_EQ(tests::get(address, target, "localhost" + port).status, 200);
  for (const std::string& host : {"evil.example" + port, std::string("127.0.0.1"),
                                  std::string("127.0.0.1:1"), "192.0.2.1" + port, port}) {
    EXPECT_EQ(tests::get(address, target, host).status, 403) << host;
  }
  EXPECT_TRUE(is_own_host("[::1]:80", 80, true));
  EXPECT_FALSE(is_own_host("192.0.2.1:80", 80, true));
  EXPECT_TRUE(is_own_host("192.0.2.1:80", 80, false));
  EXPECT_FALSE(is_own_host("evil.example:80", 80, false));
}

TEST(ViewServer, SocketsAreForItsOwnPages) {
  Noted noted;
  const Address address = noted.address();
  EXPECT_THROW(PageClient(address, "http://evil.example"), std::runtime_error);
  EXPECT_THROW(PageClient(address, "null"), std::runtime_error);
  EXPECT_THROW(PageClient(address, "", "/socket?token=0123456789abcdee"), std::runtime_error);
  EXPECT_THROW(PageClient(address, "", "/?token=" + address.token), std::runtime_error);
  PageClient client(address);
  EXPECT_EQ(noted.next(), "opened 1");
  client.say_text("hello");
  EXPECT_EQ(noted.next(), "hello");
}

TEST(ViewServer, LimitsMessages) {
  Noted noted;
  {
    PageClient client(noted.address());
    EXPECT_EQ(noted.next(), "opened 1");
    client.say_text(std::string(20000, 'x'));
    EXPECT_EQ(client.reason_of_end().substr(0, 5), "ended");
    EXPECT_EQ(noted.next(), "closed 1");
  }
  PageClient client(noted.address());
  EXPECT_EQ(noted.next(), "opened 2");
  try {
    for (int i = 0; i < 3000; ++i) client.say_text("x");
  } catch (const std::runtime_error&) {  // ended meanwhile
  }
  EXPECT_EQ(client.reason_of_end().substr(0, 5), "ended");
  std::size_t taken = 0;
  std::string last;
  while ((last = noted.next()) == "x") ++taken;
  EXPECT_EQ(last, "closed 2");
  EXPECT_GE(taken, 100U);
}

TEST(ViewServer, SendsInTheOrderInWhichItIsTold) {
  Server* server = nullptr;
  const auto send = [&](PageId id, const char* type) {
    server->send(id, std::string(R"({"type":")") + type + "\"}");
  };
  Server answering({.token = "0123456789abcdef"}, "",
                   {[](PageId) {},
                    [&](PageId id, std::string&&) {
                      send(id, "of the server's thread");
                      std::jthread([&] { send(id, "of another"); }).join();
                      send(id, "the last");
                    },
                    [](PageId) {}});
  server = &answering;
  answering.start();
  PageClient client(tests::parse_address(answering.url()));
  std::vector<std::string> types;
  client.watch([&](const nlohmann::json& message) { types.push_back(message["type"]); });
  client.say_text("hello");
  client.wait_for("the last");
  EXPECT_EQ(types, std::vector<std::string>({"of the server's thread", "of another", "the last"}));
}

TEST(ViewServer, KeepsTheNewestFrame) {
  Noted noted;
  PageClient client(noted.address());
  ASSERT_EQ(noted.next(), "opened 1");
  const std::string header = "{\"frame\":0}";
  const auto frame = [&](std::uint64_t number) {
    const std::string text = "{\"frame\":" + std::to_string(number) + "}";
    std::vector<std::byte> bytes(4 + text.size() + (std::size_t{4} << 20));
    bytes[0] = static_cast<std::byte>(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) bytes[4 + i] = static_cast<std::byte>(text[i]);
    return bytes;
  };
  constexpr std::uint64_t kFrames = 40;
  client.acknowledge(false);
  // The client does not read meanwhile: a few fit into the system's buffers, the others replace
  // each other.
  for (std::uint64_t i = 1; i <= kFrames; ++i) noted.server().send_frame(1, i, frame(i));
  noted.server().send_frame(1, 3, frame(3));  // older than what was sent
  noted.server().send(1, "{\"type\":\"end\"}");
  std::vector<std::uint64_t> seen;
  client.wait_for_frame([&](const nlohmann::json& head) {
    seen.push_back(head["frame"]);
    return seen.back() == kFrames;
  });
  EXPECT_LT(seen.size(), kFrames / 2);
  EXPECT_TRUE(std::ranges::is_sorted(seen));
}

TEST(ViewServer, SaysWhereItCannotListen) {
  Noted noted;
  EXPECT_THROW(Server({.port = noted.address().port, .token = "0123456789abcdef"}, "", {}),
               files::FileError);
  EXPECT_THROW(Server({.address = "nowhere", .token = "0123456789abcdef"}, "", {}), UsageError);
}

TEST(ViewPage, RefersToNothingOutside) {
  const std::string text = page();
  for (const char* outside : {"https://", "src=", "@import", "url(", "import("})
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
  std::size_t at = 0;
  while ((at = text.find("http://", at)) != std::string::npos) {
    EXPECT_EQ(text.substr(at, 18), "http://www.w3.org/");  // names of namespaces
    ++at;
  }
  EXPECT_NE(text.find("<script nonce=\"NONCE\">"), std::string::npos);
  EXPECT_EQ(text.find("<script>"), std::string::npos);
}

}  // namespace
}  // namespace delray::apps::view
