#include "apps/metric_options.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace nullcone {

namespace {

double one_of_the_words(const MetricParameter& p, const std::string& setting, const std::string& text) {
  for (std::size_t i = 0; i < p.words.size(); ++i)
    if (text == p.words[i]) return static_cast<double>(i);
  throw InputError("--set " + setting,
                   "expected " + std::string(p.words[0]) + " or " + std::string(p.words[1]));
}

double number_in_range(const MetricParameter& p, const std::string& setting, const std::string& text) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || text.empty() || !(value >= p.least && value <= p.most)) {
    using nlohmann::json;  // writes numbers as short as they can be read back
    throw InputError("--set " + setting,
                     "expected a number from " + json(p.least).dump() + " to " + json(p.most).dump());
  }
  return value;
}

}  // namespace

std::vector<double> parameter_values(const MetricDescription& metric,
                                     const std::vector<std::string>& settings) {
  std::vector<double> values;
  for (const MetricParameter& p : metric.parameters) values.push_back(p.fallback);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    std::size_t i = 0;
    while (i < metric.parameters.size() && metric.parameters[i].name != key) ++i;
    if (equals == std::string::npos || i == metric.parameters.size())
      throw InputError("--set " + setting,
                       "expected key=value with a parameter of " + std::string(metric.name));
    const MetricParameter& p = metric.parameters[i];
    const std::string text = setting.substr(equals + 1);
    values[i] = p.words[0].empty() ? number_in_range(p, setting, text) : one_of_the_words(p, setting, text);
  }
  return values;
}

}  // namespace nullcone
