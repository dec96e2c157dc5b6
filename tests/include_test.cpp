// Documents in several files: what stands where, whose mistake it is, and what no file may do.
#include "core/base/include.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/json.h"
#include "tests/test_folder.h"

namespace nullcone {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class Include : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ + "/parts"); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << text;
  }
  WholeJson whole(const std::string& text) const {
    write("top.json", text);
    return include_files(parse_json_file(top()), top());
  }
  std::string top() const { return folder_ + "/top.json"; }
  json document(const std::string& text) const { return whole(text).document; }
  /// Without the folder's name.
  std::string complaint(const std::string& text) const {
    try {
      whole(text);
    } catch (const InputError& error) {
      return shortened(error.what());
    }
    return {};
  }
  std::string shortened(std::string text) const {
    for (std::size_t at = text.find(folder_); at != text.npos; at = text.find(folder_))
      text.erase(at, folder_.size() + 1);
    return text;
  }
  void expect_refused(const std::string& text, const std::string& expected) const {
    const std::string found = complaint(text);
    EXPECT_NE(found.find(expected), std::string::npos) << "'" << found << "' lacks '" << expected << "'";
  }
  /// Where a reader's complaint about `pointer` of the document is told.
  std::string told(const std::string& text, const std::string& pointer, const char* beside = "") const {
    const InputError error(top() + beside + ": " + pointer, "is wrong: here");
    return shortened(whole(text).origin.told(error, top()).what());
  }

  const test::TestFolder temporary_;
  const std::string above_ = temporary_.path(), folder_ = above_ + "/scenes";
};

TEST_F(Include, AnObjectStandsForTheOneInTheFileAndIsAPatchOverIt) {
  write("a.json", R"({"$schema": "x", "a": 1, "o": {"p": 1, "q": [1, 2]}, "gone": 3} // comments too)");
  EXPECT_EQ(document(R"({"x": {"include": "a.json"}})"),
            json::parse(R"({"x": {"a": 1, "o": {"p": 1, "q": [1, 2]}, "gone": 3}})"));
  EXPECT_EQ(
      document(R"({"include": "a.json", "o": {"p": {"n": 5, "m": null}, "q": [3]}, "gone": null, "b": 2})"),
      json::parse(R"({"a": 1, "o": {"p": {"n": 5}, "q": [3]}, "b": 2})"));
}

TEST_F(Include, TheExamplesOfRfc7386) {
  const struct {
    const char *target, *patch, *result;
  } cases[] = {{R"({"a":"b"})", R"({"a":"c"})", R"({"a":"c"})"},
               {R"({"a":"b"})", R"({"b":"c"})", R"({"a":"b","b":"c"})"},
               {R"({"a":"b"})", R"({"a":null})", R"({})"},
               {R"({"a":"b","b":"c"})", R"({"a":null})", R"({"b":"c"})"},
               {R"({"a":["b"]})", R"({"a":"c"})", R"({"a":"c"})"},
               {R"({"a":"c"})", R"({"a":["b"]})", R"({"a":["b"]})"},
               {R"({"a":{"b":"c"}})", R"({"a":{"b":"d","c":null}})", R"({"a":{"b":"d"}})"},
               {R"({"a":[{"b":"c"}]})", R"({"a":[1]})", R"({"a":[1]})"},
               {R"({"e":null})", R"({"a":1})", R"({"e":null,"a":1})"},
               {R"({})", R"({"a":{"bb":{"ccc":null}}})", R"({"a":{"bb":{}}})"}};
  for (const auto& [target, patch, result] : cases) {
    write("target.json", target);
    json including = json::parse(patch);
    including["include"] = "target.json";
    EXPECT_EQ(document(including.dump()), json::parse(result)) << target << " " << patch;
  }
}

TEST_F(Include, InListsAllElementsOfAListAreTaken) {
  write("two.json", R"([{"n": 1}, {"n": 2}])");
  write("none.json", "[]");
  write("one.json", R"({"n": 3})");
  write("nested.json", R"([0, {"include": "two.json"}, [9, {"include": "two.json"}]])");
  EXPECT_EQ(document(R"([{"include": "two.json"}, 7, {"include": "none.json"}, {"include": "one.json"},
                         {"include": "one.json", "n": 4}])"),
            json::parse(R"([{"n": 1}, {"n": 2}, 7, {"n": 3}, {"n": 4}])"));
  EXPECT_EQ(document(R"({"l": [{"include": "nested.json"}]})"),
            json::parse(R"({"l": [0, {"n": 1}, {"n": 2}, [9, {"n": 1}, {"n": 2}]]})"));
}

TEST_F(Include, NamesAreRelativeToTheFileTheyStandIn) {
  write("parts/a.json", R"({"b": {"include": "b.json"}})");
  write("parts/b.json", R"({"n": 1})");
  write("b.json", R"({"n": 2})");
  EXPECT_EQ(document(R"({"include": "parts/a.json", "c": {"include": "./b.json"}})"),
            json::parse(R"({"b": {"n": 1}, "c": {"n": 2}})"));
}

TEST_F(Include, AnObjectByThatNameMayStandInALook) {
  EXPECT_EQ(document(R"({"objects": {"include": {"opacity": 1}}})"),
            json::parse(R"({"objects": {"include": {"opacity": 1}}})"));
}

TEST_F(Include, ComplaintsNameTheFileAndThePlaceInIt) {
  write("ball.json", R"({"shape": {"type": "sphere", "radius": 1}, "name": "b"})");
  write("parts/list.json", R"([{"n": 1}, {"deep": {"include": "deep.json", "over": {"o": 1}}}])");
  write("parts/deep.json", R"({"over": {"p": 2}})");
  const std::string scene = R"({"objects": [{"n": 0}, {"include": "parts/list.json"}, {"n": 5},
      {"include": "ball.json", "shape": {"radius": -1, "a/b": [1]}}]})";
  const struct {
    const char *pointer, *place;
  } cases[] = {{"/camera", "top.json: /camera"},
               {"/objects/0/n", "top.json: /objects/0/n"},
               {"/objects/1/n", "parts/list.json: /0/n"},
               {"/objects/2/deep/over/o", "parts/list.json: /1/deep/over/o"},
               {"/objects/2/deep/over/p", "parts/deep.json: /over/p"},
               {"/objects/3/n", "top.json: /objects/2/n"},
               {"/objects/4/shape/radius", "top.json: /objects/3/shape/radius"},
               {"/objects/4/shape/a~1b/0", "top.json: /objects/3/shape/a~1b/0"},
               {"/objects/4/shape/type", "ball.json: /shape/type"},
               {"/objects/4", "ball.json: /"}};
  for (const auto& [pointer, place] : cases)
    EXPECT_EQ(told(scene, pointer), std::string(place) + ": is wrong: here");
  EXPECT_EQ(told(scene, "/objects/1/n", " (frame 7)"), "parts/list.json (frame 7): /0/n: is wrong: here");
  write("base.json", R"({"a": {"b": 1}})");  // the whole file is another one
  EXPECT_EQ(told(R"({"include": "base.json", "c": 1})", "/a/b"), "base.json: /a/b: is wrong: here");
  EXPECT_EQ(told(R"({"include": "base.json", "c": 1})", "/c"), "top.json: /c: is wrong: here");
  write("removed.json",
        R"({"a": {"include": "ball.json"}})");  // what is missing then is not ball.json's affair
  EXPECT_EQ(told(R"({"include": "removed.json", "a": null})", "/a"), "removed.json: /a: is wrong: here");
  const InputError other("elsewhere.exr", "no");
  EXPECT_STREQ(whole(scene).origin.told(other, top()).what(), other.what());
}

TEST_F(Include, MistakesInAFileAreItsOwn) {
  write("broken.json", "{\n  \"a\": }");
  write("twice.json", R"({"a": {"b": 1, "b": 2}})");
  write("number.json", "7");
  write("list.json", "[1]");
  expect_refused(R"({"o": {"include": "broken.json"}})", "broken.json: line 2, column 8: not valid JSON");
  expect_refused(R"({"include": "twice.json"})", "twice.json: /a/b: the key stands twice");
  expect_refused(R"({"o": {"include": "number.json"}})", "top.json: /o/include: 'number.json' holds number");
  expect_refused(R"({"o": {"include": "list.json"}})", "top.json: /o/include: 'list.json' holds a list");
  expect_refused(R"({"o": [{"include": "list.json", "a": 1}]})", "/o/0/include: 'list.json' holds a list");
  for (const char* value : {"7", "null", "true", "[]", "[\"a.json\"]"})
    expect_refused("{\"o\": [{\"include\": " + std::string(value) + "}]}",
                   "top.json: /o/0/include: expected the name of a file");
  expect_refused(R"({"include": ""})", "/include: expected the name of a file");
}

TEST_F(Include, NothingOutsideOfTheFolderIsRead) {
  std::ofstream(above_ + "/secret.json") << "{}";
  fs::create_symlink(above_ + "/secret.json", folder_ + "/link.json");
  fs::create_directory_symlink(above_, folder_ + "/up");
  fs::create_directory(above_ + "/scenes2");  // the folder's name is only the beginning of this one's
  std::ofstream(above_ + "/scenes2/x.json") << "{}";
  fs::create_symlink(above_ + "/scenes2/x.json", folder_ + "/near.json");
  write("parts/in.json", "{}");
  fs::create_symlink("parts/in.json", folder_ + "/inner.json");
  for (const char* name :
       {"/etc/passwd", "../secret.json", "parts/../../secret.json", "parts/../b.json", ".."})
    expect_refused(json{{"include", name}}.dump(), "expected the name of a file beside this one or below");
  expect_refused(json{{"include", std::string("a\0b", 3)}}.dump(), "expected the name of a file beside");
  for (const char* name : {"link.json", "up/secret.json", "near.json"})
    expect_refused(json{{"include", name}}.dump(), "leads out of the folder of 'top.json'");
  EXPECT_EQ(document(R"({"include": "inner.json"})"), json::object());
}

TEST_F(Include, OnlyFilesAreRead) {
  ASSERT_EQ(::mkfifo((folder_ + "/pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ + "/zero");
  expect_refused(R"({"include": "none.json"})", "top.json: /include: cannot open 'none.json'");
  expect_refused(R"({"include": "parts"})", "top.json: /include: cannot read 'parts'");
  expect_refused(R"({"include": "pipe"})", "top.json: /include: cannot read 'pipe'");
  expect_refused(R"({"include": "zero"})", "leads out of the folder");
  const json scene = {{"o", {{"include", "a.json"}}}};
  EXPECT_THROW(include_files(scene, "/dev/stdin"), InputError);  // whose folder is not the scene's
  EXPECT_EQ(include_files(json{{"a", 1}}, "/dev/stdin").document, (json{{"a", 1}}));
}

TEST_F(Include, CirclesAreToldWithTheirNames) {
  write("a.json", R"({"b": [{"include": "parts/b.json"}]})");
  write("parts/b.json", R"({"c": {"include": "c.json"}})");
  fs::create_hard_link(folder_ + "/a.json", folder_ + "/copy.json");
  fs::create_symlink("../a.json", folder_ + "/parts/c.json");
  expect_refused(R"({"include": "top.json"})", "/include: includes itself: top.json -> top.json");
  expect_refused(R"({"x": {"include": "a.json"}})",
                 "parts/b.json: /c/include: includes itself: a.json -> parts/b.json -> parts/c.json");
}

TEST_F(Include, WhatGrowsWithoutEndIsRefused) {
  // A chain: each file includes the next.
  for (int i = 0; i < 20; ++i)
    write("c" + std::to_string(i) + ".json", R"({"o": {"include": "c)" + std::to_string(i + 1) + ".json\"}}");
  expect_refused(R"({"include": "c0.json"})", "expected at most 16 files that include one another");
  write("c14.json", "{}");
  EXPECT_EQ(document(R"({"include": "c0.json"})").dump().size(), 14 * 6 + 2u);
  // A billion laughs: ten of ten of ten...
  for (int i = 0; i < 9; ++i) {
    const json next = {{"include", "l" + std::to_string(i + 1) + ".json"}};
    write("l" + std::to_string(i) + ".json", json(std::vector<json>(10, next)).dump());
  }
  write("l9.json", "[1]");
  expect_refused(R"([{"include": "l0.json"}])", "expected at most 10000 files to be included in all");
  // The same with few but large files: ten of 8 MiB.
  write("large.json", "[\"" + std::string(8 << 20, 'x') + "\"]");
  write(
      "laughs.json", "[" + [] {
        std::string out;
        for (int k = 0; k < 10; ++k) out += std::string(k ? "," : "") + R"({"include": "large.json"})";
        return out;
      }() + "]");
  expect_refused(R"([{"include": "laughs.json"}])", "expected at most 64 MiB to be included in all");
  // Many small things, each of which would be remembered.
  write("many.json", json(std::vector<json>(1'100'000, json::array())).dump());
  expect_refused(R"([{"include": "many.json"}])", "expected at most 1000000 entries that stand elsewhere");
  // A gigabyte of nothing, which takes no room on the disk.
  write("huge.json", "");
  fs::resize_file(folder_ + "/huge.json", std::uintmax_t{1} << 30);
  expect_refused(R"({"include": "huge.json"})", "expected at most 64 MiB to be included in all");
  // Deep in each file, and together deeper than may be.
  std::string deep = R"({"include": "deeper.json"})", deeper = "1";
  const auto repeated = [](const std::string& text, int times) {
    std::string out;
    for (int i = 0; i < times; ++i) out += text;
    return out;
  };
  for (int i = 0; i < 40; ++i) deep = "{\"a\":" + deep + "}", deeper = "[" + deeper + "]";
  write("deeper.json", "{\"b\": " + deeper + "}");
  expect_refused(deep, "deeper.json: /b" + repeated("/0", 23) + ": nested deeper than 64");
}

}  // namespace
}  // namespace nullcone
