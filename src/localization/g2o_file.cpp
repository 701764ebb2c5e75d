// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/localization/g2o_file.hpp"

#include "prodomos/base/error.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

namespace prodomos::localization {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFix = "FIX";
constexpr std::string_view kParameters = "PARAMS_";

/// What differs between graphs in the plane and in space.
template <typename Pose>
struct Format;

template <>
struct Format<geometry::Pose2> {
  static constexpr std::string_view kVertex = "VERTEX_SE2";
  static constexpr std::string_view kEdge = "EDGE_SE2";
  static constexpr std::string_view kPoseFields = "x y theta";
  static constexpr std::size_t kNumbers = 3;

  static std::optional<geometry::Pose2> pose(const double* v) { return geometry::Pose2{v[0], v[1], v[2]}; }
  static std::array<double, kNumbers> numbers(const geometry::Pose2& pose) { return {pose.x, pose.y, pose.theta}; }
  static Eigen::Vector3d anglesOfG2o() { return Eigen::Vector3d::Ones(); }
};

template <>
struct Format<geometry::Pose3> {
  static constexpr std::string_view kVertex = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kEdge = "EDGE_SE3:QUAT";
  static constexpr std::string_view kPoseFields = "x y z qx qy qz qw";
  static constexpr std::size_t kNumbers = 7;

  static std::optional<geometry::Pose3> pose(const double* v) {
    const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
    if (std::abs(rotation.norm() - 1.0) > 0.01) return std::nullopt;
    return geometry::fromQuaternion({v[0], v[1], v[2]}, rotation);
  }
  static std::array<double, kNumbers> numbers(const geometry::Pose3& pose) {
    const auto& t = pose.translation();
    Eigen::Quaterniond q(pose.linear());
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
  }
  /// The size of our deviations in units of g2o's.
  static Eigen::Matrix<double, 6, 1> anglesOfG2o() {
    return (Eigen::Matrix<double, 6, 1>() << 1.0, 1.0, 1.0, 0.5, 0.5, 0.5).finished();
  }
};

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  constexpr std::string_view kBlanks = " \t\r";
  for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlanks, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

template <typename Number>
std::optional<Number> parse(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  Number number{};
  const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), number);
  if (fault != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return number;
}

std::string inTicks(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return '`' + std::string(text.substr(0, kLongest)) + (text.size() > kLongest ? "...`" : "`");
}

template <typename Number>
void append(std::string& text, Number number) {
  std::array<char, 32> buffer{};
  const auto [end, fault] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  text += ' ';
  text.append(buffer.data(), end);
}

/// Reads one line after the other; knows where it is.
class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path), file_(path) {
    if (!file_ || fs::is_directory(path)) {
      throw base::FileError(base::expectedFound(path.string(), "a readable g2o file", "none"));
    }
  }

  G2oFile read() {
    while (std::getline(file_, line_)) {
      ++number_;
      fields_ = fieldsOf(line_);
      readLine();
    }
    if (file_.bad()) throw base::FileError(base::expectedFound(path_.string(), "a readable g2o file", "a fault in it"));
    if (planar_.edgeLines.empty() && spatial_.edgeLines.empty()) {
      throw base::FileError(
          base::expectedFound(path_.string(), "a pose graph with edges (EDGE_SE2 or EDGE_SE3:QUAT lines)", "no edge"));
    }
    if (spatial_.edgeLines.empty()) return finish(planar_);
    return finish(spatial_);
  }

 private:
  template <typename Pose>
  struct Contents {
    Graph<Pose> graph;
    std::vector<std::size_t> edgeLines;
    std::map<std::int64_t, std::size_t> vertexLines;
  };

  void readLine() {
    using Planar = Format<geometry::Pose2>;
    using Spatial = Format<geometry::Pose3>;
    const auto tag = fields_.empty() ? std::string_view() : fields_.front();
    if (tag == Planar::kVertex) return readVertex(planar_);
    if (tag == Spatial::kVertex) return readVertex(spatial_);
    otherLines_.push_back(line_);
    if (tag == Planar::kEdge) return readEdge(planar_);
    if (tag == Spatial::kEdge) return readEdge(spatial_);
    if (tag == kFix) return readFix();
    if (tag.empty() || tag.starts_with('#') || tag.starts_with(kParameters)) return;
    fail("VERTEX_SE2, EDGE_SE2, VERTEX_SE3:QUAT, EDGE_SE3:QUAT or FIX", inTicks(tag));
  }

  template <typename Pose>
  void readVertex(Contents<Pose>& contents) {
    requireOneKind<Pose>();
    const std::string expected = std::string(Format<Pose>::kVertex) + " id " + std::string(Format<Pose>::kPoseFields);
    requireFields(2 + Format<Pose>::kNumbers, expected);
    const auto id = idAt(1);
    if (const auto [earlier, isNew] = contents.vertexLines.emplace(id, number_); !isNew) {
      fail("each vertex once",
           "vertex " + std::to_string(id) + " of line " + std::to_string(earlier->second) + " again");
    }
    contents.graph.vertices.push_back({.id = id, .pose = poseAt<Pose>(2)});
  }

  template <typename Pose>
  void readEdge(Contents<Pose>& contents) {
    requireOneKind<Pose>();
    constexpr int kDimension = kDegreesOfFreedom<Pose>;
    constexpr std::size_t kEntries = kDimension * (kDimension + 1) / 2;
    const std::string expected = std::string(Format<Pose>::kEdge) + " from to " +
                                 std::string(Format<Pose>::kPoseFields) + " and the " + std::to_string(kEntries) +
                                 " numbers of the information matrix's upper triangle";
    requireFields(3 + Format<Pose>::kNumbers + kEntries, expected);
    Constraint<Pose> edge{.from = idAt(1), .to = idAt(2), .T_from_to = poseAt<Pose>(3)};
    if (edge.from == edge.to)
      fail("an edge between two vertices", "one from " + std::to_string(edge.from) + " to itself");
    std::size_t field = 3 + Format<Pose>::kNumbers;
    MotionMatrix<Pose> information;
    for (int row = 0; row < kDimension; ++row) {
      for (int column = row; column < kDimension; ++column) {
        information(row, column) = information(column, row) = numberAt(field++);
      }
    }
    if (Eigen::LLT<MotionMatrix<Pose>>(information).info() != Eigen::Success) {
      fail("a positive definite information matrix",
           "another at edge " + std::to_string(edge.from) + " -> " + std::to_string(edge.to));
    }
    const auto ofG2o = Format<Pose>::anglesOfG2o();
    edge.information = ofG2o.asDiagonal() * information * ofG2o.asDiagonal();
    contents.graph.constraints.push_back(edge);
    contents.edgeLines.push_back(number_);
  }

  void readFix() {
    if (fields_.size() < 2) fail("FIX id ...", inTicks(line_));
    for (std::size_t i = 1; i < fields_.size(); ++i) fixed_.emplace_back(idAt(i), number_);
  }

  template <typename Pose>
  G2oFile finish(Contents<Pose>& contents) {
    auto& graph = contents.graph;
    const bool hasPoses = !graph.vertices.empty();
    const auto require = [&](std::int64_t id, std::size_t line) {
      if (contents.vertexLines.contains(id)) return;
      number_ = line;
      fail("a vertex that the file has", "vertex " + std::to_string(id) + ", which has no line of its own");
    };
    for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
      for (const auto id : {graph.constraints[i].from, graph.constraints[i].to}) {
        if (hasPoses) require(id, contents.edgeLines[i]);
        if (!hasPoses) contents.vertexLines.emplace(id, contents.edgeLines[i]);
      }
    }
    if (!hasPoses) {
      for (const auto& [id, line] : contents.vertexLines) graph.vertices.push_back({.id = id});
    }
    for (const auto& [id, line] : fixed_) require(id, line);
    std::ranges::sort(fixed_);
    for (auto& vertex : graph.vertices) {
      vertex.isFixed = std::ranges::binary_search(fixed_, vertex.id, {}, [](const auto& fix) { return fix.first; });
    }
    return {.graph = std::move(graph), .hasPoses = hasPoses, .otherLines = std::move(otherLines_)};
  }

  template <typename Pose>
  void requireOneKind() {
    constexpr bool kIsPlanar = std::is_same_v<Pose, geometry::Pose2>;
    const bool hasOther = kIsPlanar ? !spatial_.graph.vertices.empty() || !spatial_.edgeLines.empty()
                                    : !planar_.graph.vertices.empty() || !planar_.edgeLines.empty();
    if (hasOther) fail("either SE2 or SE3:QUAT throughout, as before", inTicks(fields_.front()));
  }

  void requireFields(std::size_t count, const std::string& expected) const {
    if (fields_.size() != count) {
      fail(expected + " (" + std::to_string(count) + " fields)", std::to_string(fields_.size()) + " fields");
    }
  }

  std::int64_t idAt(std::size_t field) const {
    const auto id = parse<std::int64_t>(fields_[field]);
    if (!id) fail("the id of a vertex", inTicks(fields_[field]));
    return *id;
  }

  double numberAt(std::size_t field) const {
    const auto number = parse<double>(fields_[field]);
    if (!number || !std::isfinite(*number)) fail("a finite number", inTicks(fields_[field]));
    return *number;
  }

  template <typename Pose>
  Pose poseAt(std::size_t field) const {
    std::array<double, Format<Pose>::kNumbers> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = numberAt(field + i);
    const auto pose = Format<Pose>::pose(numbers.data());
    if (!pose) fail("a quaternion of length 1", inTicks(line_));
    return *pose;
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw base::FileError(base::expectedFound(path_.string() + ":" + std::to_string(number_), expected, found));
  }

  fs::path path_;
  std::ifstream file_;
  std::string line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  Contents<geometry::Pose2> planar_;
  Contents<geometry::Pose3> spatial_;
  std::vector<std::pair<std::int64_t, std::size_t>> fixed_;  ///< id and line
  std::vector<std::string> otherLines_;
};

template <typename Pose>
void appendPose(std::string& text, const Pose& pose) {
  for (const double number : Format<Pose>::numbers(pose)) append(text, number);
}

template <typename Pose>
std::string vertexLines(const Graph<Pose>& graph) {
  std::string text;
  for (const auto& vertex : graph.vertices) {
    text += Format<Pose>::kVertex;
    append(text, vertex.id);
    appendPose(text, vertex.pose);
    text += '\n';
  }
  return text;
}

template <typename Pose>
G2oFile withLines(const Graph<Pose>& graph) {
  G2oFile file{.graph = graph, .hasPoses = true};
  for (const auto& vertex : graph.vertices) {
    if (vertex.isFixed) file.otherLines.push_back(std::string(kFix) + ' ' + std::to_string(vertex.id));
  }
  const MotionMatrix<Pose> toG2oUnits = Format<Pose>::anglesOfG2o().cwiseInverse().asDiagonal();
  for (const auto& edge : graph.constraints) {
    std::string line(Format<Pose>::kEdge);
    append(line, edge.from);
    append(line, edge.to);
    appendPose(line, edge.T_from_to);
    const MotionMatrix<Pose> information = toG2oUnits * edge.information * toG2oUnits;
    for (int row = 0; row < information.rows(); ++row) {
      for (int column = row; column < information.cols(); ++column) append(line, information(row, column));
    }
    file.otherLines.push_back(std::move(line));
  }
  return file;
}

}  // namespace

G2oFile readG2o(const fs::path& path) {
  return Reader(path).read();
}

void writeG2o(const G2oFile& file, const fs::path& path) {
  // Beside it first, so that a full disk leaves no half of a graph.
  auto part = path;
  part += ".part";
  bool isWhole = false;
  {
    std::ofstream stream(part, std::ios::binary | std::ios::trunc);
    stream << std::visit([](const auto& graph) { return vertexLines(graph); }, file.graph);
    for (const auto& line : file.otherLines) stream << line << '\n';
    stream.close();
    isWhole = !stream.fail();
  }
  std::error_code fault;
  if (isWhole) fs::rename(part, path, fault);
  if (!isWhole || fault) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw base::FileError(
        base::expectedFound(path.string(), "a file that can be written",
                            fault ? fault.message() : "no such folder, no permission or a full disk"));
  }
}

G2oFile toG2o(const PoseGraph& graph) {
  return withLines(graph);
}

G2oFile toG2o(const PlanarPoseGraph& graph) {
  return withLines(graph);
}

}  // namespace prodomos::localization
