// The independent numbers of tests/data/reference_cases.json, each with its own tolerance.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/base/vector.h"

namespace nullcone::test {

using json = nlohmann::json;

/// All cases of one topic; a topic without cases is a fault of the test.
inline std::vector<json> cases_of(const std::string& topic) {
  static const json all = json::parse(std::ifstream(NULLCONE_TEST_DATA "/reference_cases.json"));
  std::vector<json> out;
  for (const json& c : all["cases"])
    if (c["topic"] == topic) out.push_back(c);
  EXPECT_FALSE(out.empty()) << "no reference case of topic " << topic;
  return out;
}

inline double tolerance(const json& c, double expected) {
  return c["tol"].value("abs", 0.0) + c["tol"].value("rel", 0.0) * std::fabs(expected);
}

/// Compares with a case's own tolerance.
inline void expect_case(const json& c, const std::string& what, double value, double expected) {
  EXPECT_NEAR(value, expected, tolerance(c, expected)) << c["id"] << " " << what;
}

inline host::Vec4<double> to_vec4(const json& list) { return {{list[0], list[1], list[2], list[3]}}; }
inline host::Vec3<double> to_vec3(const json& list) { return {{list[0], list[1], list[2]}}; }

}  // namespace nullcone::test
