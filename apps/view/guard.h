// Who may ask for what, and how often: judged from the head of a request alone.
#pragma once

#include <chrono>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "apps/view/http_server.h"

namespace nullcone::view {

inline constexpr int kMostPending = 8;  ///< requests of one viewer that are not answered yet

/// So many tokens a second, at most `burst` saved up.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;
  TokenBucket(double rate, double burst) : rate_(rate), burst_(burst), tokens_(burst) {}
  bool take(Clock::time_point now);

 private:
  double rate_, burst_, tokens_;
  Clock::time_point last_{};
};

struct GuardRules {
  std::string token;            ///< first segment of all paths; empty: none is asked for
  std::set<std::string> hosts;  ///< names that this server goes by, without port
  bool any_ip = false;          ///< also any IP address as a host
  std::size_t viewers = 8;      ///< pages at a time
  std::size_t most_upload = 64'000'000, most_look = 4'000'000;  ///< bytes
  double rate = 300;                                            ///< requests a second of a viewer
};

/// Token, Host, Origin, viewers, rates and sizes. For one thread.
class Guard {
 public:
  using Clock = TokenBucket::Clock;
  explicit Guard(GuardRules rules);

  HttpServer::Admission admit(const Head& head, Clock::time_point now);
  /// An answer has been written, or will never be.
  void end(const Head& head, Clock::time_point now);

  /// The path of an admitted request behind the token, without its query: "" or "api/frame".
  std::string_view path(const Head& head) const;

 private:
  struct Viewer {
    TokenBucket rate;
    int pending = 0;
    Clock::time_point last;
  };
  int status_of(const Head& head, std::string& why);
  bool admit_viewer(const std::string& id, Clock::time_point now);

  GuardRules rules_;
  std::map<std::string, Viewer, std::less<>> viewers_;
  TokenBucket pages_{200, 400};  ///< requests for the page itself
  int uploads_ = 0;
};

/// The name in a header Host, in small letters, without port and brackets.
std::string host_name(std::string_view host);

/// 32 hex digits from the system's source of randomness.
std::string random_token();

}  // namespace nullcone::view
