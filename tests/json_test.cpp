// Strict JSON: every complaint names its place, and no text can hurt the reader.
#include "core/base/json.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"

namespace nullcone {
namespace {

using nlohmann::json;

/// What `work` complains about; empty if it does not.
template <class Work>
std::string complaint(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string parse_complaint(std::string_view text) {
  return complaint([&] { parse_json(text, "file"); });
}

void expect_within(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
}

std::string repeated(std::string_view text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

TEST(Json, SyntaxErrorsNameLineAndColumn) {
  const struct {
    const char *text, *place;
  } cases[] = {
      {"{\n  \"a\": 1,\n  \"b\": }\n", "file: line 3, column 8: not valid JSON"},
      {"[1, 2", "file: line 1, column 6: not valid JSON"},
      {"x", "file: line 1, column 1: not valid JSON"},
      {"{\"a\": 1,}", "file: line 1, column 9: not valid JSON"},
      {"[1] 2", "file: line 1, column 5: not valid JSON"},
      {"// a comment\n[ /* and\nanother */ }", "file: line 3, column 12: not valid JSON"},
      {"# no\n[]", "file: line 1, column 1: not valid JSON"},
      {"{'a': 1}", "file: line 1, column 2: not valid JSON"},
      {"[01]", "file: line 1, column 3: not valid JSON"},
      {"[+1]", "file: line 1, column 2: not valid JSON"},
      {"[.5]", "file: line 1, column 2: not valid JSON"},
  };
  for (const auto& [text, place] : cases) expect_within(parse_complaint(text), place);
  expect_within(parse_complaint("[\"a\nb\"]"), "not valid JSON");
}

TEST(Json, CommentsAreSkipped) {
  const json found = parse_json(
      "// of the file\n{ /* here */ \"a\" /**/ : // there\r\n [1, /* 2, */ 3], \"b\": \"// no /* comment "
      "*/\"}\n//",
      "file");
  EXPECT_EQ(canonical_json(found), R"({"a":[1,3],"b":"// no /* comment */"})");
  expect_within(parse_complaint("{\"a\": 1 /* no end }"), "not valid JSON");
  expect_within(parse_complaint("{\"a\": 1} / "), "not valid JSON");
  expect_within(parse_complaint("/* /* */ */ {}"), "file: line 1, column 10: not valid JSON");
  EXPECT_EQ(parse_complaint("{} // \xff"), "");  // its bytes are no text
  expect_within(parse_complaint("{\"a\": 1, /* twice */ \"a\": 2}"), "file: /a: the key stands twice");
  expect_within(parse_complaint(std::string_view("{} // \0", 7)), "a zero byte");
}

TEST(Json, EmptyTextsAreRefused) {
  for (const char* text : {"", " ", "\n\t\r\n", "\xEF\xBB\xBF", "// nothing", "/* nothing */"})
    expect_within(parse_complaint(text), "not valid JSON");
}

TEST(Json, WordsThatAreNoNumbersAreRefused) {
  for (const char* text :
       {"[NaN]", "[nan]", "[Infinity]", "[-Infinity]", "[inf]", "[0x10]", "[1e]", "[1.]", "[--1]"})
    expect_within(parse_complaint(text), "not valid JSON");
}

TEST(Json, NumbersBeyondDoubleAreRefusedWithTheirPlace) {
  expect_within(parse_complaint("[1e999]"), "file: /0: not valid JSON: a number is too large");
  expect_within(parse_complaint("{\"a\": [0, {\"b\": 2, \"c\": -1e999}]}"), "file: /a/1/c: not valid JSON");
  EXPECT_EQ(parse_json("[1e308, 1e-999, -0.0]", "file")[1].get<double>(), 0.0);
  // Whole numbers beyond 64 bits become the nearest double.
  EXPECT_EQ(parse_json("[123456789012345678901234567890]", "file")[0].get<double>(),
            123456789012345678901234567890.0);
}

TEST(Json, InvalidUtf8IsRefused) {
  for (const char* bytes : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\x80"}) {
    expect_within(parse_complaint("{\"a\": \"" + std::string(bytes) + "\"}"), "file: line 1, column ");
    expect_within(parse_complaint("{\"" + std::string(bytes) + "\": 1}"), "not valid JSON");
  }
  for (const char* lone : {"\"\\ud800\"", "\"\\udc00\"", "\"\\ud800\\u0041\""})
    expect_within(parse_complaint(lone), "not valid JSON");
  EXPECT_EQ(parse_json("\"\xce\xb1 \\ud834\\udd1e\"", "file").get<std::string>(),
            "\xce\xb1 \xf0\x9d\x84\x9e");
}

TEST(Json, AByteOrderMarkIsSkipped) {
  EXPECT_EQ(parse_json("\xEF\xBB\xBF{\"a\": 1}", "file")["a"], 1);
  expect_within(parse_complaint(std::string("\xff\xfe{\0}\0", 6)), "not valid JSON");  // UTF-16
}

TEST(Json, ANulByteIsRefused) {
  expect_within(parse_complaint(std::string("{\"a\": 1}\0x", 10)), "not valid JSON");
  expect_within(parse_complaint(std::string("{\"a\0b\": 1}", 10)), "not valid JSON");
}

TEST(Json, DuplicateKeysAreRefusedWithTheirPointer) {
  const struct {
    const char *text, *place;
  } cases[] = {
      {R"({"a": 1, "a": 1})", "file: /a: "},
      {R"({"a": {"b": 1, "c": 2, "b": 3}})", "file: /a/b: "},
      {R"({"x": [0, [], {}, {"k": 1, "k": 2}]})", "file: /x/3/k: "},
      {R"([[{"k": 1}, {"k": 2}], [{"k": [1, 2], "k": 2}]])", "file: /1/0/k: "},
      {R"({"a/b": {"c~d": 1, "c~d": 2}})", "file: /a~1b/c~0d: "},
      {R"({"k": 1, "\u006b": 2})", "file: /k: "},
      {R"({"": 1, "": 2})", "file: /: "},
  };
  for (const auto& [text, place] : cases) {
    const std::string found = parse_complaint(text);
    expect_within(found, place);
    expect_within(found, "stands twice");
  }
  EXPECT_EQ(parse_complaint(R"({"a": {"k": 1}, "b": {"k": 1}, "c": [{"k": 1}, {"k": 1}]})"), "");
}

TEST(Json, NestingBeyond64IsRefusedAtOnce) {
  EXPECT_EQ(parse_complaint(repeated("[", 64) + repeated("]", 64)), "");
  for (const int depth : {65, 66, 1000, 1'000'000}) {
    expect_within(parse_complaint(repeated("[", depth) + repeated("]", depth)), "nested deeper than 64");
    expect_within(parse_complaint(repeated("{\"a\":", depth) + "1" + repeated("}", depth)),
                  "nested deeper than 64");
    expect_within(parse_complaint(repeated("[", depth)), "nested deeper than 64");
  }
}

TEST(Json, LongTextsAreReadAndComplaintsStayOneShortLine) {
  const std::string big(10'000'000, 'q');
  EXPECT_EQ(parse_json("[\"" + big + "\"]", "file")[0].get_ref<const std::string&>().size(), big.size());
  for (const std::string& text :
       {"[\"" + big, "{\"" + big + "\": 1, \"" + big + "\": 2}", "{\"a\": " + big, "[\"a\nb\x07\"]" + big,
        std::string(R"({"a\n\u0007": 1, "a\n\u0007": 2})")}) {
    const std::string found = parse_complaint(text);
    EXPECT_FALSE(found.empty());
    EXPECT_LT(found.size(), 1100u);  // 400 of place, 600 of message, and the marks between
    EXPECT_EQ(found.find('\n'), std::string::npos);
    EXPECT_EQ(found.find('\x07'), std::string::npos);
  }
}

TEST(Json, CanonicalTextForgetsOrderAndSpace) {
  const auto canonical = [](const char* text) { return canonical_json(parse_json(text, "file")); };
  EXPECT_EQ(canonical(R"({"b": [1, {"y": 2, "x": 1}], "a": 0.1})"), R"({"a":0.1,"b":[1,{"x":1,"y":2}]})");
  EXPECT_EQ(canonical("{\"a\":0.1,\n\"b\":[1,{\"x\":1,\t\"y\":2}]}"),
            canonical(R"({"b":[1,{"y":2,"x":1}],"a":0.1})"));
  EXPECT_NE(canonical("[1, 2]"), canonical("[2, 1]"));
  EXPECT_NE(canonical("[0.1]"), canonical("[0.10000000000000002]"));
  EXPECT_EQ(canonical("[0.1]"), canonical("[0.1000000000000000055511151231257827]"));
}

TEST(JsonObject, EveryAccessorNamesThePointer) {
  const json d =
      parse_json(R"({"o": {"t": 5, "n": "x", "b": 1, "w": "red", "l": [1, "x", 3], "big": 7, "f": 1.5,
                                      "neg": -1, "zero": 0, "objects": [{}, 3]}})",
                 "file");
  JsonObject root(d, "file", "");
  JsonObject o = root.object("o");
  const auto says = [&](auto&& work, const char* expected) { expect_within(complaint(work), expected); };
  says([&] { o.text("missing"); }, "file: /o/missing: missing");
  says([&] { o.text("t"); }, "file: /o/t: expected a text");
  says([&] { o.number("n"); }, "file: /o/n: expected a number, found string");
  says([&] { o.boolean("b", false); }, "file: /o/b: expected true or false, found number");
  says([&] { o.word("w", {"green", "blue"}); }, "file: /o/w: 'red' is unknown; expected one of green, blue");
  says([&] { o.numbers("l", 3); }, "file: /o/l/1: expected a number, found string");
  says([&] { o.numbers("l", 2); }, "file: /o/l: expected a list of 2 numbers");
  says([&] { o.number("big", 0, 6); }, "file: /o/big: is 7; expected a number from 0 to 6");
  says([&] { o.integer("f", 0, 9); }, "file: /o/f: is 1.5; expected a whole number");
  says([&] { o.positive("neg"); }, "file: /o/neg: is -1; expected a number greater than 0");
  says([&] { o.positive("zero"); }, "file: /o/zero: is 0; expected");
  says([&] { o.object("t"); }, "file: /o/t: expected an object");
  says([&] { o.objects("t"); }, "file: /o/t: expected a list");
  says([&] { o.objects("objects"); }, "file: /o/objects/1: expected an object");
  says([&] { JsonObject(json::array(), "file", ""); }, "file: /: expected an object");
}

TEST(JsonObject, FinishRefusesWhatNobodyAskedFor) {
  const json d = parse_json(R"({"a/b~c": 1, "known": 2})", "file");
  JsonObject root(d, "file", "");
  root.number("known");
  root.number_or("absent", 3);
  expect_within(complaint([&] { root.finish(); }),
                "file: /a~1b~0c: unknown key; expected one of absent, known");
  EXPECT_EQ(root.number("a/b~c"), 1.0);
  EXPECT_EQ(complaint([&] { root.finish(); }), "");
}

TEST(JsonObject, SlashesInKeysAreEscapedInPointers) {
  const json d = parse_json(R"({"a/b": {"c~d": {}}, "l/m": [1]})", "file");
  JsonObject root(d, "file", "");
  JsonObject inner = root.object("a/b").object("c~d");
  expect_within(complaint([&] { inner.number("q"); }), "file: /a~1b/c~0d/q: missing");
  expect_within(complaint([&] { root.objects("l/m"); }), "file: /l~1m/0: expected an object");
}

TEST(JsonFile, WhatCannotBeReadIsNamed) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("nullcone_json_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto says = [&](const std::string& path, std::size_t largest, const char* expected) {
    expect_within(complaint([&] { parse_json_file(path, largest); }), expected);
  };
  const std::string path = folder / "a.json";
  std::ofstream(path) << "[" << std::string(3 << 20, ' ') << "]";
  says(path, std::size_t{1} << 20, "larger than 1 MiB");
  says(folder / "none.json", 100, "cannot open the file");
  says(folder, 100, "cannot read the file");
  says("/dev/zero", std::size_t{1} << 20, "larger than 1 MiB");
  says("/dev/null", 100, "not valid JSON");
  EXPECT_EQ(parse_json_file(path).size(), 0u);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace nullcone
