// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/evaluation/truth.hpp"

#include "prodomos/base/error.hpp"

#include "evaluation/truth_keys.hpp"

#include <nlohmann/json.hpp>

#include <concepts>
#include <fstream>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

namespace prodomos::evaluation {

namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order of their description

constexpr int kVersion = 1;
constexpr std::string_view kFormat = "prodomos truth";

// --- writing ---

/// JSON of a value. What is not finite becomes null.
struct Writer {
  template <typename T>
  Json operator()(const T& value) const {
    if constexpr (std::is_enum_v<T>) {
      return std::string(toString(value));
    } else if constexpr (std::is_arithmetic_v<T> || std::same_as<T, std::string>) {
      return value;
    } else {
      Json object = Json::object();
      auto key = [this, &object](const char* name, const auto& field) { object[name] = (*this)(field); };
      describe(key, value);
      return object;
    }
  }
  template <typename T, std::size_t kSize>
  Json operator()(const std::array<T, kSize>& values) const {
    return list(values);
  }
  template <typename T>
  Json operator()(const std::vector<T>& values) const {
    return list(values);
  }
  template <int kSize>
  Json operator()(const Eigen::Matrix<double, kSize, 1>& vector) const {
    return list(vector);
  }
  template <typename T>
  Json operator()(const std::optional<T>& value) const {
    return value ? (*this)(*value) : Json(nullptr);
  }
  Json operator()(const base::Time& time) const { return base::toString(time); }
  Json operator()(const geometry::Pose3& pose) const {
    const Eigen::Vector3d t = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
  }
  Json operator()(const sensors::ClassTable& classes) const {
    Json table = Json::object();
    for (const auto& [id, name] : classes) table[std::to_string(id)] = name;
    return table;
  }

 private:
  Json list(const auto& values) const {
    Json array = Json::array();
    for (const auto& value : values) array.push_back((*this)(value));
    return array;
  }
};

/// An element a line, so that the file can be looked at and compared.
std::string asText(const Json& document) {
  std::string text = "{";
  for (const auto& [name, value] : document.items()) {
    text += (text.size() > 1 ? ",\n" : "\n") + Json(name).dump() + ": ";
    if (!value.is_array() || value.empty()) {
      text += value.dump();
      continue;
    }
    text += '[';
    for (std::size_t i = 0; i < value.size(); ++i) text += (i > 0 ? ",\n  " : "\n  ") + value[i].dump();
    text += "]";
  }
  return text + "\n}\n";
}

// --- reading ---

/// A value of the file and where it stands: "doors[3].width".
struct Found {
  const Json& value;
  std::string place;

  [[noreturn]] void fail(const std::string& expected) const {
    std::string found = value.dump();
    if (found.size() > 60) found = found.substr(0, 57) + "...";
    throw base::Error(base::expectedFound(place, expected, found));
  }
  Found operator[](std::size_t index) const { return {value[index], place + "[" + std::to_string(index) + "]"}; }
  Found operator[](const std::string& name) const {
    if (!value.is_object()) fail("an object");
    const std::string inside = place.empty() ? name : place + "." + name;
    const auto found = value.find(name);
    if (found == value.end()) throw base::Error(base::expectedFound(inside, "a value", "no such key"));
    return {*found, inside};
  }
  const Found& array(std::optional<std::size_t> size = std::nullopt) const {
    if (!value.is_array() || (size && value.size() != *size)) {
      fail(size ? "an array of " + std::to_string(*size) : std::string("an array"));
    }
    return *this;
  }
};

/// A value of JSON; throws base::Error naming the place where it is not one.
struct Reader {
  template <typename T>
  void operator()(const Found& found, T& value) const {
    if constexpr (std::is_enum_v<T>) {
      name(found, value);
    } else if constexpr (std::is_arithmetic_v<T>) {
      number(found, value);
    } else if constexpr (std::same_as<T, std::string>) {
      if (!found.value.is_string()) found.fail("a text");
      value = found.value.get<std::string>();
    } else {
      auto key = [this, &found](const char* name, auto& field) { (*this)(found[name], field); };
      describe(key, value);
    }
  }
  template <typename T, std::size_t kSize>
  void operator()(const Found& found, std::array<T, kSize>& values) const {
    found.array(kSize);
    for (std::size_t i = 0; i < kSize; ++i) (*this)(found[i], values[i]);
  }
  template <typename T>
  void operator()(const Found& found, std::vector<T>& values) const {
    values.resize(found.array().value.size());
    for (std::size_t i = 0; i < values.size(); ++i) (*this)(found[i], values[i]);
  }
  template <int kSize>
  void operator()(const Found& found, Eigen::Matrix<double, kSize, 1>& vector) const {
    found.array(kSize);
    for (int i = 0; i < kSize; ++i) (*this)(found[static_cast<std::size_t>(i)], vector[i]);
  }
  template <typename T>
  void operator()(const Found& found, std::optional<T>& value) const {
    value.reset();
    if (!found.value.is_null()) (*this)(found, value.emplace());
  }
  void operator()(const Found& found, base::Time& time) const {
    const auto parsed = found.value.is_string() ? base::parseSeconds(found.value.get<std::string>()) : std::nullopt;
    if (!parsed) found.fail("a time, as \"12.345\"");
    time = *parsed;
  }
  void operator()(const Found& found, geometry::Pose3& pose) const {
    std::array<double, 7> v{};
    (*this)(found, v);
    const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
    if (rotation.norm() < 0.5) found.fail("x y z qx qy qz qw with a quaternion of length 1");
    pose = geometry::fromQuaternion({v[0], v[1], v[2]}, rotation);
  }
  void operator()(const Found& found, sensors::ClassTable& classes) const {
    if (!found.value.is_object()) found.fail("an object");
    classes.clear();
    for (const auto& [id, name] : found.value.items()) {
      const bool isNumber = !id.empty() && id.size() < 6 && id.find_first_not_of("0123456789") == std::string::npos;
      if (!isNumber || !name.is_string()) found.fail("names by number");
      classes[std::stoi(id)] = name;
    }
  }

 private:
  template <typename T>
  static void number(const Found& found, T& number) {
    const Json& value = found.value;
    if constexpr (std::same_as<T, bool>) {
      if (!value.is_boolean()) found.fail("true or false");
    } else if constexpr (std::floating_point<T>) {
      if (!value.is_number() && !value.is_null()) found.fail("a number");
    } else {
      if (!value.is_number_integer()) found.fail("a whole number");
      const bool fits = value.is_number_unsigned() ? std::in_range<T>(value.get<std::uint64_t>())
                                                   : std::in_range<T>(value.get<std::int64_t>());
      if (!fits) found.fail("a smaller number");
    }
    number = value.is_null() ? std::numeric_limits<T>::quiet_NaN() : value.get<T>();
  }

  template <typename Enum>
  static void name(const Found& found, Enum& value) {
    std::string names;
    for (const auto candidate : Names<Enum>::kValues) {
      if (found.value == toString(candidate)) {
        value = candidate;
        return;
      }
      names += (names.empty() ? "" : ", ") + std::string(toString(candidate));
    }
    found.fail("one of " + names);
  }
};

}  // namespace

std::filesystem::path truthPath(const std::filesystem::path& log) {
  auto path = log;
  if (path.extension() == ".gz") path.replace_extension();
  return path.replace_extension(".truth.json");
}

Truth readTruth(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw base::FileError(base::expectedFound(path.string(), "a truth file", "none that can be read"));
  }
  try {
    const Json document = Json::parse(file);
    const Found root{document, ""};
    if (!document.is_object() || !document.contains("format") || document["format"] != kFormat) {
      throw base::Error(base::expectedFound("format", '"' + std::string(kFormat) + '"', "another kind of JSON"));
    }
    if (root["version"].value != kVersion) root["version"].fail(std::to_string(kVersion));
    Truth truth;
    Reader{}(root, truth);
    return truth;
  } catch (const Json::parse_error& fault) {
    throw base::FileError(base::expectedFound(path.string() + ", byte " + std::to_string(fault.byte), "JSON",
                                              "a file that is damaged or cut"));
  } catch (const Json::exception& fault) {
    throw base::FileError(base::expectedFound(path.string(), "a truth file", fault.what()));
  } catch (const base::Error& fault) {
    throw base::FileError(path.string() + ", " + fault.what());
  }
}

void writeTruth(const Truth& truth, const std::filesystem::path& path) {
  Json document = {{"format", kFormat}, {"version", kVersion}};
  document.update(Writer{}(truth));
  std::ofstream file(path, std::ios::binary);
  file << asText(document);
  file.close();
  if (!file) throw base::FileError(base::expectedFound(path.string(), "a place to write the truth", "none"));
}

}  // namespace prodomos::evaluation
