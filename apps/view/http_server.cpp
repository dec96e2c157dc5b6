#include "apps/view/http_server.h"

#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>

#include "apps/view/http_connection.h"

namespace nullcone::view {

Answer refusal(int status, std::string_view message) {
  const nlohmann::json body = {{"error", message}};
  return {status, "application/json", body.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)};
}

namespace {

tcp::endpoint endpoint_of(const std::string& address, int port) {
  error_code error;
  const asio::ip::address ip = asio::ip::make_address(address, error);
  if (error) throw InputError("--bind", "expected an IP address, found '" + printable(address, 60) + "'");
  return {ip, static_cast<unsigned short>(port)};
}

}  // namespace

struct HttpServer::Impl {
  Impl(const std::string& address, int port, const HttpLimits& limits, int workers)
      : shared(limits, workers), acceptor(shared.context), signals(shared.context, SIGINT, SIGTERM) {
    const tcp::endpoint endpoint = endpoint_of(address, port);
    error_code error;
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(1024, error);
    if (error)
      throw WorkError(address + " port " + std::to_string(port), "cannot serve there: " + error.message());
    signals.async_wait([this](error_code failed, int) {
      if (!failed) shared.context.stop();
    });
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (!error) welcome(std::move(socket));
      if (!error) return accept();
      // No more file handles: one that waits gives its own up, and a moment passes.
      if (!shared.waiting.empty()) shared.waiting.front()->give_up();
      pause.expires_after(std::chrono::milliseconds(20));
      pause.async_wait([this](error_code) { accept(); });
    });
  }

  void welcome(tcp::socket socket) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    const bool full = shared.open >= shared.limits.connections;
    if (full && !shared.waiting.empty()) shared.waiting.front()->give_up();
    const auto connection = std::make_shared<Connection>(std::move(socket), shared);
    if (shared.open > shared.limits.connections + kLeaving)
      connection->refuse(view::refusal(429, "too many connections"));
    else
      connection->wait();
  }
  static constexpr std::size_t kLeaving = 64;  ///< those that gave up still count for a moment

  Shared shared;
  tcp::acceptor acceptor;
  asio::signal_set signals;
  asio::steady_timer pause{shared.context};
};

HttpServer::HttpServer(const std::string& address, int port, const HttpLimits& limits, int workers)
    : impl_(std::make_unique<Impl>(address, port, limits, workers)) {}

HttpServer::~HttpServer() {
  impl_->shared.workers.stop();
  impl_->shared.workers.join();
}

int HttpServer::port() const { return impl_->acceptor.local_endpoint().port(); }

void HttpServer::run(Admit admit, Handle handle, Written written) {
  impl_->shared.admit = std::move(admit);
  impl_->shared.handle = std::move(handle);
  impl_->shared.written = std::move(written);
  impl_->accept();
  impl_->shared.context.run();
}

void HttpServer::stop() { impl_->shared.context.stop(); }

}  // namespace nullcone::view
