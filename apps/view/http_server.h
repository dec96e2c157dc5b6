// A small HTTP server: reads requests, hands them to workers, writes their answers. It knows nothing of
// datasets. By Boost.Beast, asynchronously in one thread, so that slow and silent peers cost nobody else
// time.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nullcone::view {

/// What stands before the body of a request; empty where a header is missing.
struct Head {
  std::string method, target;
  std::string host, origin, site, viewer;  ///< headers Host, Origin, Sec-Fetch-Site, X-Nullcone-Viewer
};

struct Request {
  Head head;
  std::string body;
};

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
};

/// {"error": message}
Answer refusal(int status, std::string_view message);

struct HttpLimits {
  std::size_t connections = 256;  ///< beyond, those that have waited longest make room
  std::size_t head_bytes = 16384;
  std::chrono::seconds request{20};  ///< from the first byte to the last, texture files apart
  std::chrono::seconds upload{300};
  std::chrono::seconds idle{60}, write{120};
};

class HttpServer {
 public:
  /// Judges a request before its body is read: how many bytes that may have, or a refusal.
  struct Admission {
    std::size_t most_bytes = 0;
    bool refused = false;
    Answer refusal = {};
  };
  /// Called in the server's own thread: must be quick.
  using Admit = std::function<Admission(const Head&)>;
  /// Called in one of the workers' threads.
  using Handle = std::function<Answer(const Request&)>;
  /// Called when all of an answer has been written, or its peer has gone, with its body; in the server's own
  /// thread.
  using Written = std::function<void(const Head&, std::string body)>;

  /// Binds to `address` (an IP address) and `port` (0: any free one). Throws InputError for addresses that
  /// there are not, and WorkError where the port is taken.
  HttpServer(const std::string& address, int port, const HttpLimits& limits, int workers);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// Serves until stop(). What `handle` throws becomes status 500.
  void run(Admit admit, Handle handle, Written written);
  /// May be called from any thread, and from signal handlers' threads.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nullcone::view
