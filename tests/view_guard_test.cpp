// Who is let in, what queries may say, and which files looks from strangers may name.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/view/guard.h"
#include "apps/view/looks.h"
#include "apps/view/query.h"
#include "core/base/error.h"

namespace nullcone::view {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = Guard::Clock;

const Clock::time_point kNow = Clock::now();
const std::string kViewer = "0123456789abcdef";

GuardRules local_rules() { return {"", {"localhost", "127.0.0.1", "::1"}}; }

Head asking(const std::string& target, const std::string& method = "GET") {
  return {method, target, "localhost:8080", "", "", kViewer};
}

int status_of(Guard& guard, const Head& head, Clock::time_point now = kNow) {
  const HttpServer::Admission admission = guard.admit(head, now);
  if (!admission.refused) guard.end(head, now);
  return admission.refused ? admission.refusal.status : 200;
}

TEST(ViewGuard, LetsItsOwnPageIn) {
  Guard guard(local_rules());
  EXPECT_EQ(status_of(guard, asking("/")), 200);
  EXPECT_EQ(status_of(guard, asking("/api/state")), 200);
  Head page = asking("/api/frame?data=0", "POST");
  page.origin = "http://localhost:8080";
  page.site = "same-origin";
  EXPECT_EQ(status_of(guard, page), 200);
  EXPECT_EQ(guard.path(page), "api/frame");
}

TEST(ViewGuard, RefusesOtherNamesAndPages) {
  Guard guard(local_rules());
  for (const std::string host :
       {"", "evil.example", "localhost.evil.example", "evil.example:8080", "10.0.0.7"}) {
    Head head = asking("/");
    head.host = host;
    EXPECT_EQ(status_of(guard, head), 421) << host;
  }
  for (const std::string origin :
       {"http://evil.example", "null", "http://localhost:9999", "https://localhost"}) {
    Head head = asking("/api/frame", "POST");
    head.origin = origin;
    EXPECT_EQ(status_of(guard, head), 403) << origin;
  }
  Head cross = asking("/api/state");
  cross.site = "cross-site";
  EXPECT_EQ(status_of(guard, cross), 403);
  Head anonymous = asking("/api/state");
  for (const std::string id : {"", "0123", "0123456789ABCDEF", "0123456789abcdeg", "0123456789abcdef0"}) {
    anonymous.viewer = id;
    EXPECT_EQ(status_of(guard, anonymous), 400) << id;
  }
  EXPECT_EQ(status_of(guard, asking("/", "POST")), 405);
  EXPECT_EQ(status_of(guard, asking("/api/state", "DELETE")), 405);
  EXPECT_EQ(status_of(guard, asking("/api/state?" + std::string(5000, 'x'))), 414);
}

TEST(ViewGuard, AsksForTheToken) {
  GuardRules rules = local_rules();
  rules.token = random_token();
  EXPECT_EQ(rules.token.size(), 32U);
  EXPECT_NE(rules.token, random_token());
  Guard guard(rules);
  EXPECT_EQ(status_of(guard, asking("/")), 404);
  EXPECT_EQ(status_of(guard, asking("/" + rules.token)), 404);  // as every wrong one
  EXPECT_EQ(status_of(guard, asking("/" + std::string(32, '0') + "/")), 404);
  const Head right = asking("/" + rules.token + "/api/state?a=1");
  EXPECT_EQ(status_of(guard, right), 200);
  EXPECT_EQ(guard.path(right), "api/state");
}

TEST(ViewGuard, LimitsRatesViewersAndSizes) {
  GuardRules rules = local_rules();
  rules.viewers = 2;
  rules.rate = 10;
  Guard guard(rules);
  int accepted = 0;
  for (int i = 0; i < 100; ++i) accepted += status_of(guard, asking("/api/state")) == 200;
  EXPECT_EQ(accepted, 10);
  EXPECT_EQ(status_of(guard, asking("/api/state"), kNow + milliseconds(150)), 200);
  // A third page waits until one of the two others has been silent for a minute.
  Head second = asking("/api/state"), third = second;
  second.viewer.back() = '0';
  third.viewer.back() = '1';
  EXPECT_EQ(status_of(guard, second, kNow + seconds(30)), 200);
  EXPECT_EQ(status_of(guard, third, kNow + seconds(31)), 429);
  EXPECT_EQ(status_of(guard, third, kNow + seconds(75)), 200);
  EXPECT_EQ(status_of(guard, second, kNow + seconds(75)), 200);
  // Bodies.
  EXPECT_EQ(guard.admit(asking("/api/frame", "POST"), kNow + seconds(200)).most_bytes, rules.most_look);
  EXPECT_EQ(guard.admit(asking("/api/state"), kNow + seconds(200)).most_bytes, 0U);
}

TEST(ViewGuard, LimitsWhatIsUnderWay) {
  Guard guard(local_rules());
  const Head frame = asking("/api/frame", "POST"), upload = asking("/api/texture", "POST");
  for (int i = 0; i < kMostPending; ++i) EXPECT_FALSE(guard.admit(frame, kNow).refused);
  EXPECT_TRUE(guard.admit(frame, kNow).refused);
  guard.end(frame, kNow);
  EXPECT_FALSE(guard.admit(frame, kNow).refused);
  for (int i = 0; i < kMostPending; ++i) guard.end(frame, kNow);
  EXPECT_FALSE(guard.admit(upload, kNow).refused);
  EXPECT_FALSE(guard.admit(upload, kNow).refused);
  EXPECT_TRUE(guard.admit(upload, kNow).refused);
  guard.end(upload, kNow);
  EXPECT_FALSE(guard.admit(upload, kNow).refused);
}

TEST(ViewGuard, KnowsNamesOfHosts) {
  EXPECT_EQ(host_name("LocalHost:80"), "localhost");
  EXPECT_EQ(host_name("[::1]:8080"), "::1");
  EXPECT_EQ(host_name("127.0.0.1"), "127.0.0.1");
  EXPECT_EQ(host_name("["), "");
  EXPECT_EQ(host_name(""), "");
}

std::string complaint_of(const std::string& target, const std::string& key = "n") {
  try {
    Query query(target);
    query.integer(key, 0, 100);
    query.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ViewQuery, IsReadStrictly) {
  Query query("/api/x?n=7&name=a%20b+c%2F%C3%A4&from=-1.5e3&to=");
  EXPECT_EQ(query.integer("n", 0, 9), 7);
  EXPECT_EQ(query.text("name"), "a b c/\xC3\xA4");
  EXPECT_EQ(query.number("from"), -1500.0);
  EXPECT_EQ(query.number("to"), std::nullopt);
  query.finish();
  EXPECT_EQ(complaint_of("/?n=5"), "");
  for (const std::string wrong :
       {"/", "/?", "/?n", "/?n=", "/?n=101", "/?n=-1", "/?n=1.5", "/?n=1e1", "/?n=5&n=6", "/?n=5&m=1",
        "/?n=99999999999999999999", "/?n=%", "/?n=%4", "/?n=%zz", "/?n= 5"})
    EXPECT_NE(complaint_of(wrong), "") << wrong;
  for (const std::string wrong : {"nan", "inf", "1e999", "0x10", "1,5", "--1"})
    EXPECT_THROW(Query("/?x=" + wrong).number("x"), InputError) << wrong;
}

// Looks.

Manifest manifest_with(const std::string& look) {
  Manifest out;
  out.set_size(2, 2);
  out.objects = {{"ball"}};
  out.scene = R"({"look":)" + look + "}";
  return out;
}

const std::string kEarth = "/usr/share/xplanet/images/earth.jpg";

nlohmann::json with_texture(const std::string& file) {
  return {{"objects", {{"ball", {{"texture", {{"type", "image"}, {"file", file}}}}}}}};
}

TEST(ViewLooks, NameNoFilesOfTheirOwnChoice) {
  const Manifest manifest = manifest_with(with_texture(kEarth).dump());
  const TemporaryFolder folder;
  const Looks looks(manifest, "out/data.exr", "", {}, folder);
  EXPECT_NO_THROW(looks.parse(with_texture(kEarth), manifest, 0));
  for (const std::string file :
       {"/etc/passwd", "earth.jpg", "../earth.jpg", "/usr/share/xplanet/images/./earth.jpg"})
    EXPECT_THROW(looks.parse(with_texture(file), manifest, 0), InputError) << file;
  const auto refused = [&](const std::string& text) {
    EXPECT_THROW(looks.parse(nlohmann::json::parse(text), manifest, 0), InputError) << text;
  };
  refused(R"({"objects":{"ball":{"spectrum":{"type":"tabulated","file":"/etc/passwd"}}}})");
  refused(R"({"sensor":{"file":"/etc/passwd"}})");
  refused(R"({"tone":{"curve":"table","file":"/etc/passwd"}})");
  refused(
      R"({"objects":{"ball":{"texture":{"type":"image","file":"/etc/####","sequence":{"frames":[0,9]}}}}})");
  refused(R"({"objects":{"ball":{"texture":{"type":"materials","file":"/etc/passwd"},
                                 "spectrum":{"type":"materials","spectra":[{"type":"constant"}]}}}})");
  refused(R"({"objects":{"ball":{"time_slices":[{"texture":{"type":"image","file":"/etc/passwd"}}]}}})");
  refused(R"({"lights":{"sun":{"spectrum":{"type":"tabulated","file":"/etc/passwd"}}}})");
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ViewLooks, TakePicturesIn) {
  const Manifest manifest = manifest_with("{}");
  const TemporaryFolder folder;
  Looks looks(manifest, "data.exr", "", {}, folder);
  const std::string earth = bytes_of(kEarth), night = bytes_of("/usr/share/xplanet/images/night.jpg");
  const Looks::Texture sent = looks.add_texture("../..\\map one.jpg", earth);
  EXPECT_EQ(sent.name, "map-one.jpg");
  EXPECT_EQ(sent.width, 2048);
  EXPECT_EQ(sent.height, 1024);
  EXPECT_EQ(looks.add_texture("map-one.jpg", night).name, "map-one-2.jpg");
  EXPECT_EQ(looks.add_texture("map-one.jpg", earth).name, "map-one.jpg");  // the same again
  const postrender::Look look = looks.parse(with_texture("map-one.jpg"), manifest, 0);
  const auto& image = std::get<postrender::ImageLook>(*look.objects.at("ball").appearance.texture);
  EXPECT_EQ(bytes_of(image.file), earth);
  for (const std::string& wrong : {std::string(), std::string("no picture"), earth.substr(0, 1000)}) try {
      looks.add_texture("x.jpg", wrong);
      FAIL() << "took " << wrong.size() << " bytes";
    } catch (const InputError& error) {
      EXPECT_EQ(looks.told(error.what()).find("nullcone-view-"), std::string::npos)
          << looks.told(error.what());
    }
  EXPECT_THROW(looks.parse(with_texture("x.jpg"), manifest, 0), InputError);
}

}  // namespace
}  // namespace nullcone::view
