// nullcone-view: datasets in the browser.
#include <malloc.h>
#include <spawn.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>

#include "apps/tool.h"
#include "apps/view/api.h"
#include "core/base/error.h"
#include "core/record/memory.h"
#include "postrender/frames.h"

namespace {

using namespace nullcone;
using namespace nullcone::view;

struct Options {
  ToolOptions common;
  ApiOptions api;
  std::string bind = "127.0.0.1", frames;
  std::vector<std::string> hosts;
  int port = 0, upload_megabytes = 64;
  std::size_t viewers = 8;
  bool token = false, open = false;
};

bool is_loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

GuardRules rules_for(const Options& options) {
  GuardRules out;
  const bool loopback = is_loopback(options.bind);
  if (options.token || !loopback) out.token = random_token();
  out.hosts = {"localhost", "127.0.0.1", "::1", options.bind};
  out.any_ip = !loopback;
  std::array<char, 256> machine{};
  if (!loopback && gethostname(machine.data(), machine.size() - 1) == 0)
    out.hosts.insert(host_name(machine.data()));
  for (const std::string& host : options.hosts) out.hosts.insert(host_name(host));
  out.viewers = options.viewers;
  out.most_upload = static_cast<std::size_t>(options.upload_megabytes) * 1'000'000;
  return out;
}

std::string address_of(const Options& options, int port, const std::string& token) {
  const bool six = options.bind.find(':') != std::string::npos;
  std::string host = six ? "[" + options.bind + "]" : options.bind;
  if (host == "0.0.0.0" || host == "[::]") {
    std::array<char, 256> machine{};
    if (gethostname(machine.data(), machine.size() - 1) == 0) host = machine.data();
  }
  return "http://" + host + ":" + std::to_string(port) + "/" + (token.empty() ? "" : token + "/");
}

/// Shows the page in the user's browser, if there is one.
void open_browser(const std::string& address) {
  std::array<char*, 3> words = {const_cast<char*>("xdg-open"), const_cast<char*>(address.c_str()), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, words[0], nullptr, nullptr, words.data(), environ) != 0)
    std::fputs("nullcone-view: no xdg-open here; open the address by hand\n", stderr);
}

void check_options(Options& options) {
  if (options.api.data.empty()) throw InputError("DATA", "is required (see --help)");
  if (!options.frames.empty() && options.api.data.size() > 1)
    throw InputError("--frames", "expected one dataset: several are a time line by themselves");
  if (options.frames.empty()) return;
  const std::vector<int> frames = parse_frames(options.frames);
  const auto [least, greatest] = std::ranges::minmax(frames);
  options.api.frames = {least, greatest};
}

int work(Options& options) {
  check_options(options);
  std::optional<tbb::global_control> threads;
  if (options.common.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism,
                    static_cast<std::size_t>(options.common.threads));
  const GuardRules rules = rules_for(options);
  options.api.most_bytes = available_memory() / 2;
  options.api.most_viewers = 2 * options.viewers;
  options.api.most_upload = rules.most_upload;
  Api api(options.api);
  Guard guard(rules);
  // A worker for each request that may be under way: those of one viewer wait for one another.
  HttpServer server(options.bind, options.port, {}, static_cast<int>(options.viewers) * kMostPending);
  const std::string address = address_of(options, server.port(), rules.token);
  std::printf("%s\n", address.c_str());
  std::fflush(stdout);
  if (options.open) open_browser(address);
  const auto now = [] { return Guard::Clock::now(); };
  server.run([&](const Head& head) { return guard.admit(head, now()); },
             [&](const Request& request) { return api.answer(request, guard.path(request.head)); },
             [&](const Head& head, std::string body) {
               guard.end(head, now());
               api.reuse(std::move(body));
             });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Pictures go back to the system when they are done with. Else each worker's heap keeps some: 600 MiB and
  // rising in place of 320 for pictures of 1280 x 1024.
  mallopt(M_MMAP_THRESHOLD, 4'000'000);
  CLI::App app("Shows datasets in the browser: looks can be changed there, and scenes moved.",
               "nullcone-view");
  Options options;
  add_common_options(app, options.common);
  app.add_option("DATA", options.api.data, "dataset (.exr), or several: frames of a sequence");
  app.add_option("--look", options.api.look_file, "look (.json) to begin with, in place of the scene's own");
  app.add_option("--set", options.api.settings, "path=value: overrides an entry of that look (repeatable)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--frames", options.frames,
                 "0-249: a time line for the keyframes of looks, over one dataset");
  app.add_option("--port", options.port, "port (default: any free one)")->check(CLI::Range(0, 65535));
  app.add_option("--bind", options.bind,
                 "IP address to serve at (127.0.0.1); other machines' addresses get a secret token");
  app.add_option("--host", options.hosts, "name by which browsers may call this server (repeatable)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--token", options.token, "ask for a secret token in the address, also on this machine");
  app.add_option("--viewers", options.viewers, "most pages at a time (8)")->check(CLI::Range(1, 64));
  app.add_option("--upload-mb", options.upload_megabytes,
                 "largest texture that may be sent, in megabytes (64)")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--open", options.open, "open the page in the browser");
  return run_tool(app, argc, argv, [&] { return work(options); });
}
