#include "apps/view/guard.h"

#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>

#include "core/base/error.h"

namespace nullcone::view {

namespace {

constexpr int kMostUploads = 2;                 ///< at a time, of all viewers
constexpr std::chrono::seconds kForgotten{60};  ///< a viewer that was silent so long makes room for others

bool is_viewer_id(std::string_view id) {
  return id.size() == 16 && id.find_first_not_of("0123456789abcdef") == id.npos;
}

bool is_ip(const std::string& host) {
  boost::system::error_code error;
  boost::asio::ip::make_address(host, error);
  return !error;
}

}  // namespace

bool TokenBucket::take(Clock::time_point now) {
  if (last_ != Clock::time_point{})
    tokens_ = std::min(burst_, tokens_ + rate_ * std::chrono::duration<double>(now - last_).count());
  last_ = now;
  if (tokens_ < 1) return false;
  tokens_ -= 1;
  return true;
}

std::string host_name(std::string_view host) {
  const bool bracket = host.starts_with('[');
  const std::size_t end = bracket ? host.find(']') : host.rfind(':');
  std::string out(host.substr(bracket ? 1 : 0, end == host.npos ? end : end - (bracket ? 1 : 0)));
  std::ranges::transform(out, out.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return out;
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw WorkError("token", "the system has no random numbers");
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const unsigned char byte : bytes) out += {kDigits[byte >> 4], kDigits[byte & 15]};
  return out;
}

Guard::Guard(GuardRules rules) : rules_(std::move(rules)) {}

std::string_view Guard::path(const Head& head) const {
  std::string_view path = head.target;
  path = path.substr(0, path.find('?'));
  return path.substr(std::min(path.size(), rules_.token.empty() ? 1 : rules_.token.size() + 2));
}

/// 0: nothing speaks against it.
int Guard::status_of(const Head& head, std::string& why) {
  const auto refuse = [&](int status, const char* reason) {
    why = reason;
    return status;
  };
  const std::string host = host_name(head.host);
  if (!rules_.hosts.contains(host) && !(rules_.any_ip && is_ip(host)))
    return refuse(421, "this server does not go by that name");
  if (!head.origin.empty() && head.origin != "http://" + head.host && head.origin != "https://" + head.host)
    return refuse(403, "only this server's own page may ask");
  const bool own = head.site.empty() || head.site == "same-origin" || head.site == "none";
  const std::string prefix = rules_.token.empty() ? "/" : "/" + rules_.token + "/";
  if (!head.target.starts_with(prefix)) return refuse(404, "no such page");
  const bool api = path(head).starts_with("api/");
  // A link on another site may lead to the page, but only the page may use it.
  if (!own && api) return refuse(403, "only this server's own page may ask");
  const bool get = head.method == "GET" || head.method == "HEAD";
  if (!get && !(api && head.method == "POST")) return refuse(405, "expected GET, or POST to api/");
  if (head.target.size() > 4096) return refuse(414, "the address is too long");
  if (api && !is_viewer_id(head.viewer))
    return refuse(400, "expected a header X-Nullcone-Viewer with 16 hex digits");
  return 0;
}

/// Whether there is room for this viewer, and it has asked neither too often nor too much.
bool Guard::admit_viewer(const std::string& id, Clock::time_point now) {
  auto found = viewers_.find(id);
  if (found == viewers_.end()) {
    std::erase_if(viewers_, [&](const auto& entry) {
      return viewers_.size() >= rules_.viewers && entry.second.pending == 0 &&
             now - entry.second.last > kForgotten;
    });
    if (viewers_.size() >= rules_.viewers) return false;
    found = viewers_.emplace(id, Viewer{TokenBucket(rules_.rate, rules_.rate), 0, now}).first;
  }
  Viewer& viewer = found->second;
  if (viewer.pending >= kMostPending || !viewer.rate.take(now)) return false;
  ++viewer.pending;
  viewer.last = now;
  return true;
}

HttpServer::Admission Guard::admit(const Head& head, Clock::time_point now) {
  const auto refuse = [](int status, std::string_view why) {
    return HttpServer::Admission{0, true, refusal(status, why)};
  };
  std::string why;
  if (const int status = status_of(head, why); status != 0) return refuse(status, why);
  if (!path(head).starts_with("api/")) {
    if (!pages_.take(now)) return refuse(429, "too many requests");
    return {};
  }
  const bool upload = path(head) == "api/texture";
  if (upload && uploads_ >= kMostUploads) return refuse(429, "other files are being sent; once more, please");
  if (!admit_viewer(head.viewer, now)) {
    const bool known = viewers_.contains(head.viewer);
    return refuse(429,
                  known ? "too many requests" : "too many viewers; close another page, or wait a minute");
  }
  if (upload) ++uploads_;
  return {head.method == "POST" ? (upload ? rules_.most_upload : rules_.most_look) : 0};
}

void Guard::end(const Head& head, Clock::time_point now) {
  if (path(head) == "api/texture") --uploads_;
  const auto found = viewers_.find(head.viewer);
  if (found == viewers_.end() || !path(head).starts_with("api/")) return;
  --found->second.pending;
  found->second.last = now;
}

}  // namespace nullcone::view
