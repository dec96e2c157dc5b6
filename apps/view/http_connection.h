// One peer of the HTTP server. Included by http_server.cpp alone: Beast is slow to compile.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cstdio>
#include <list>
#include <optional>

#include "apps/view/http_server.h"
#include "core/base/error.h"

namespace nullcone::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using beast::error_code;

class Connection;

/// What all connections share; touched in the server's thread only, but for the workers.
struct Shared {
  HttpLimits limits;
  asio::thread_pool workers;
  HttpServer::Admit admit;
  HttpServer::Handle handle;
  HttpServer::Written written;
  std::size_t open = 0;
  std::list<Connection*> waiting;  ///< for a request, or for their peers to close; the longest first
  asio::io_context context{1};     ///< goes first, and with it the connections

  Shared(const HttpLimits& limits_, int workers_)
      : limits(limits_), workers(static_cast<std::size_t>(workers_)) {}
};

/// What keeps browsers from doing more with an answer than it is meant for.
inline constexpr std::array<std::pair<const char*, const char*>, 6> kSafety = {
    {{"Content-Security-Policy",
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
      "'self'; "
      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
     {"X-Content-Type-Options", "nosniff"},
     {"Referrer-Policy", "no-referrer"},
     {"Cross-Origin-Resource-Policy", "same-origin"},
     {"Cross-Origin-Opener-Policy", "same-origin"},
     {"Cache-Control", "no-store"}}};

/// One peer: requests one after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket&& socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {
    ++shared_.open;
  }
  ~Connection() {
    stop_waiting();
    end_request();
    --shared_.open;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits for a request. Those that wait make room when there are too many connections.
  void wait() {
    head_.emplace();
    head_->header_limit(static_cast<std::uint32_t>(shared_.limits.head_bytes));
    head_->body_limit(UINT64_MAX);  // the judge says how much
    start_waiting();
    if (buffer_.size() > 0) return on_first_bytes({}, 0);
    stream_.expires_after(shared_.limits.idle);
    stream_.async_read_some(buffer_.prepare(4096),
                            beast::bind_front_handler(&Connection::on_first_bytes, shared_from_this()));
  }

  /// The last answer on this connection.
  void refuse(Answer answer) {
    keep_alive_ = false;
    write(std::move(answer));
  }

  /// Closes a connection that waits.
  void give_up() {
    stop_waiting();
    static constexpr std::string_view kGone =
        "HTTP/1.1 408 Request Timeout\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
    error_code ignored;
    stream_.socket().non_blocking(true, ignored);
    if (!last_answer_given_) stream_.socket().write_some(asio::buffer(kGone), ignored);
    stream_.close();
  }

 private:
  void start_waiting() { waiting_place_ = shared_.waiting.insert(shared_.waiting.end(), this); }
  void stop_waiting() {
    if (waiting_place_) shared_.waiting.erase(*waiting_place_);
    waiting_place_.reset();
  }
  void end_request() {
    if (!std::exchange(admitted_, false)) return;
    shared_.written(request_.head, response_ ? std::move(response_->body()) : std::string());
  }

  /// From here on a request has to come soon.
  void on_first_bytes(error_code error, std::size_t bytes) {
    if (error) return;
    buffer_.commit(bytes);
    stream_.expires_after(shared_.limits.request);
    http::async_read_header(stream_, buffer_, *head_,
                            beast::bind_front_handler(&Connection::on_head, shared_from_this()));
  }

  void on_head(error_code error, std::size_t) {
    stop_waiting();
    if (error == http::error::header_limit) return refuse(refusal(431, "the header is too long"));
    if (error == beast::error::timeout) return refuse(refusal(408, "the request took too long"));
    const bool broken = error.category() == make_error_code(http::error::bad_method).category();
    if (broken && error != http::error::end_of_stream)
      return refuse(refusal(400, "expected a request in HTTP/1.1"));
    if (error) return;
    const auto& fields = head_->get();
    const auto text = [&](std::string_view name) { return std::string(fields[{name.data(), name.size()}]); };
    request_.head = {std::string(fields.method_string()),
                     std::string(fields.target()),
                     text("Host"),
                     text("Origin"),
                     text("Sec-Fetch-Site"),
                     text("X-Nullcone-Viewer")};
    keep_alive_ = head_->keep_alive();
    if (fields.count("Host") != 1 || fields.count("Origin") > 1 || head_->chunked())
      return refuse(refusal(400, "expected one header Host, at most one Origin, and no chunks"));
    HttpServer::Admission admission = shared_.admit(request_.head);
    if (admission.refused) return refuse(std::move(admission.refusal));
    admitted_ = true;
    read_body(admission.most_bytes);
  }

  void read_body(std::size_t most) {
    body_.emplace(std::move(*head_));
    body_->body_limit(most);
    const std::uint64_t length = body_->content_length().value_or(0);
    if (length > most)
      return refuse(
          refusal(413, "the body is too long; expected at most " + std::to_string(most) + " bytes"));
    if (length > kLongBody) stream_.expires_after(shared_.limits.upload);
    if (!beast::iequals(body_->get()[http::field::expect], "100-continue")) return read_rest();
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(stream_, asio::buffer(kContinue),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error) self->read_rest();
                      });
  }
  static constexpr std::uint64_t kLongBody = 4'000'000;

  void read_rest() {
    http::async_read(stream_, buffer_, *body_,
                     beast::bind_front_handler(&Connection::on_body, shared_from_this()));
  }

  void on_body(error_code error, std::size_t) {
    if (error == http::error::body_limit) return refuse(refusal(413, "the body is too long"));
    if (error == beast::error::timeout) return refuse(refusal(408, "the request took too long"));
    if (error) return;
    request_.body = std::move(body_->get().body());
    body_.reset();
    stream_.expires_never();
    asio::post(shared_.workers, [self = shared_from_this()]() mutable {
      auto answer = std::make_shared<Answer>(self->work());
      Shared& shared = self->shared_;
      asio::post(shared.context, [self = std::move(self), answer] { self->write(std::move(*answer)); });
    });
  }

  Answer work() const noexcept {
    try {
      return shared_.handle(request_);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "nullcone-view: %s\n", printable(error.what(), 400).c_str());
      return refusal(500, "the server could not do this; its terminal says why");
    }
  }

  void write(Answer answer) {
    response_.emplace();
    response_->result(static_cast<unsigned>(answer.status));
    response_->set(http::field::content_type, answer.type);
    for (const auto& [name, value] : kSafety) response_->set(name, value);
    for (const auto& [name, value] : answer.headers) response_->set(name, value);
    response_->keep_alive(keep_alive_);
    response_->content_length(answer.body.size());
    if (request_.head.method != "HEAD") response_->body() = std::move(answer.body);
    stream_.expires_after(shared_.limits.write);
    http::async_write(stream_, *response_,
                      beast::bind_front_handler(&Connection::on_written, shared_from_this()));
  }

  void on_written(error_code error, std::size_t) {
    end_request();
    response_.reset();
    request_ = {};
    if (error) return;
    if (keep_alive_) return wait();
    // What the peer still sends is read away for a moment: closing over it would take the answer with it.
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    last_answer_given_ = true;
    start_waiting();
    stream_.expires_after(std::chrono::seconds(2));
    drain(std::size_t{1} << 26);
  }
  void drain(std::size_t most) {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(16384),
                            [self = shared_from_this(), most](error_code error, std::size_t bytes) {
                              if (!error && bytes < most) self->drain(most - bytes);
                            });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> head_;
  std::optional<http::request_parser<http::string_body>> body_;
  std::optional<http::response<http::string_body>> response_;
  Request request_;
  std::optional<std::list<Connection*>::iterator> waiting_place_;
  bool keep_alive_ = false, admitted_ = false, last_answer_given_ = false;
};

}  // namespace nullcone::view
