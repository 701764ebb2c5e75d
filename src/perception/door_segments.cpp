// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "perception/door_segments.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace prodomos::perception {

namespace {

/// Pixels on each side that a difference is taken of: oblique and distant walls are blurred by so much.
constexpr int kSide = 2;

/// Differences of the two pixels after and the two before, halved; of the three channels the greatest. `step` leads to
/// the neighbour across the edge, in elements.
cv::Mat differences(const cv::Mat& color, bool across) {
  cv::Mat smooth;
  cv::blur(color, smooth, across ? cv::Size(1, 3) : cv::Size(3, 1));
  cv::Mat result(color.size(), CV_16S, cv::Scalar(0));
  const auto pitch = static_cast<std::ptrdiff_t>(smooth.step1());
  const std::ptrdiff_t step = across ? 3 : pitch;
  const int marginX = across ? kSide : 0;
  const int marginY = across ? 0 : kSide;
  for (int row = marginY; row < color.rows - marginY; ++row) {
    const std::uint8_t* pixel = smooth.ptr<std::uint8_t>(row) + 3 * marginX;
    auto* out = result.ptr<std::int16_t>(row);
    for (int column = marginX; column < color.cols - marginX; ++column, pixel += 3) {
      int greatest = 0;
      for (int channel = 0; channel < 3; ++channel) {
        const std::uint8_t* at = pixel + channel;
        const int difference = at[step] + at[2 * step] - at[-step] - at[-2 * step];
        if (std::abs(difference) > std::abs(greatest)) greatest = difference;
      }
      out[column] = static_cast<std::int16_t>(greatest / 2);
    }
  }
  return result;
}

/// Keeps what is at least `contrast` and no less than its neighbours across the edge; where the wall is not seen, there
/// is no edge.
cv::Mat thinned(const cv::Mat& differences, const RectifiedWall& wall, bool across, int contrast) {
  cv::Mat result(differences.size(), CV_16S, cv::Scalar(0));
  const auto pitch = static_cast<std::ptrdiff_t>(differences.step1());
  const std::ptrdiff_t step = across ? 1 : pitch;
  for (int row = kSide; row < differences.rows - kSide; ++row) {
    const auto* in = differences.ptr<std::int16_t>(row);
    auto* out = result.ptr<std::int16_t>(row);
    for (int column = kSide; column < differences.cols - kSide; ++column) {
      const std::int16_t* at = in + column;
      const int size = std::abs(*at);
      if (size < contrast) continue;
      if (size < std::abs(at[-step]) || size < std::abs(at[-2 * step])) continue;
      if (size <= std::abs(at[step]) || size <= std::abs(at[2 * step])) continue;
      const Seen seen = wall.seen(column, row);
      if (seen != Seen::kWall && seen != Seen::kColor) continue;
      out[column] = *at;
    }
  }
  return result;
}

/// A run of edge pixels, downwards, as it grows.
struct Run {
  double column = 0.0;  ///< of its last pixels, smoothed
  int last = 0;         ///< row of the last pixel
  bool brightens = false;
  int top = 0;
  int pixels = 0;
  double contrast = 0.0;  ///< sums, from here on
  double rows = 0.0, columns = 0.0, rowRows = 0.0, rowColumns = 0.0;

  void add(int atColumn, int row, int difference) {
    if (pixels == 0) {
      top = row;
      column = atColumn;
      brightens = difference > 0;
    }
    column += 0.4 * (atColumn - column);
    last = row;
    ++pixels;
    contrast += std::abs(difference);
    rows += row;
    columns += atColumn;
    rowRows += static_cast<double>(row) * row;
    rowColumns += static_cast<double>(row) * atColumn;
  }
  void add(const Run& other) {
    top = std::min(top, other.top);
    last = std::max(last, other.last);
    pixels += other.pixels;
    contrast += other.contrast;
    rows += other.rows;
    columns += other.columns;
    rowRows += other.rowRows;
    rowColumns += other.rowColumns;
  }

  UprightLine line() const {
    const double n = pixels;
    UprightLine line;
    line.middleRow = rows / n;
    line.column = columns / n;
    const double spread = rowRows - rows * rows / n;
    line.slope = spread > 0.0 ? (rowColumns - rows * columns / n) / spread : 0.0;
    line.top = top;
    line.bottom = last;
    line.pixels = pixels;
    line.contrast = contrast / n;
    return line;
  }
};

/// Links the edge pixels of each row to runs that end just above.
std::vector<Run> linkRuns(const cv::Mat& upright) {
  constexpr int kGap = 6;           // rows without an edge that a run bridges
  constexpr double kAside = 1.6;    // columns from one pixel to the next
  constexpr int kLeastPixels = 12;  // 18 cm
  std::vector<Run> open;            // by column, nearly
  std::vector<Run> done;
  for (int row = 0; row < upright.rows; ++row) {
    std::erase_if(open, [&](const Run& run) {
      if (row - run.last <= kGap) return false;
      if (run.pixels >= kLeastPixels) done.push_back(run);
      return true;
    });
    const auto* edge = upright.ptr<std::int16_t>(row);
    std::vector<Run> begun;
    for (int column = 0; column < upright.cols; ++column) {
      if (edge[column] == 0) continue;
      const bool brightens = edge[column] > 0;
      Run* best = nullptr;
      double nearest = kAside;
      for (auto run = std::ranges::lower_bound(open, column - 3.0 * kAside, {}, &Run::column);
           run != open.end() && run->column < column + 3.0 * kAside; ++run) {
        const double aside = std::abs(run->column - column);
        if (aside >= nearest || run->last == row || run->brightens != brightens) continue;
        nearest = aside;
        best = &*run;
      }
      if (best == nullptr) best = &begun.emplace_back();
      best->add(column, row, edge[column]);
    }
    open.insert(open.end(), begun.begin(), begun.end());
    std::ranges::stable_sort(open, {}, &Run::column);
  }
  std::ranges::copy_if(open, std::back_inserter(done), [](const Run& run) { return run.pixels >= kLeastPixels; });
  return done;
}

bool leansLess(const Run& run, double tolerance) {
  return std::abs(run.line().slope) < std::tan(tolerance);
}

/// Whether two runs are pieces of one line: a handle, a change of the wall's colour or a sign interrupts it.
bool continues(const Run& a, const Run& b, double tolerance) {
  constexpr double kOff = 1.8;  // columns
  const UprightLine above = a.line();
  const UprightLine below = b.line();
  const bool overlap = std::min(a.last, b.last) - std::max(a.top, b.top) > 4;
  if (overlap) return false;
  const double rows = std::abs(above.middleRow - below.middleRow);
  const double slope = (below.column - above.column) / (below.middleRow - above.middleRow);
  if (std::abs(slope) > std::tan(tolerance)) return false;
  const auto off = [&](const UprightLine& line) {
    return std::abs(line.slope - slope) * 0.5 * (line.bottom - line.top);
  };
  return rows > 0.0 && off(above) < kOff && off(below) < kOff;
}

}  // namespace

WallEdges::WallEdges(const RectifiedWall& wall, double contrast) {
  const int least = std::max(1, static_cast<int>(contrast));
  upright_ = thinned(differences(wall.color(), true), wall, true, least);
  const cv::Mat level = thinned(differences(wall.color(), false), wall, false, least);
  cv::Mat isEdge = (upright_ != 0) | (level != 0);
  cv::integral(isEdge / 255, edgeCount_, CV_32S);
  const cv::Mat isLevel = level != 0;
  cv::Mat thick;
  cv::dilate(isLevel, thick, cv::getStructuringElement(cv::MORPH_RECT, {1, 3}));
  levelCount_ = cv::Mat(thick.rows, thick.cols + 1, CV_32S);
  for (int row = 0; row < thick.rows; ++row) {
    const auto* in = thick.ptr<std::uint8_t>(row);
    auto* out = levelCount_.ptr<int>(row);
    out[0] = 0;
    for (int column = 0; column < thick.cols; ++column) out[column + 1] = out[column] + (in[column] != 0 ? 1 : 0);
  }
}

std::vector<UprightLine> WallEdges::uprightLines(double tolerance) const {
  constexpr double kNear = 6.0;  // columns
  constexpr int kLeastPixels = 24;
  std::vector<Run> runs = linkRuns(upright_);
  std::erase_if(runs, [&](const Run& run) { return !leansLess(run, tolerance); });
  // The longest first, so that they gather what continues them.
  std::ranges::stable_sort(runs, std::greater{}, &Run::pixels);
  std::vector<Run> lines;
  for (const Run& run : runs) {
    const double column = run.columns / run.pixels;
    const auto line = std::ranges::find_if(lines, [&](const Run& known) {
      return std::abs(known.columns / known.pixels - column) < kNear && continues(known, run, tolerance);
    });
    if (line == lines.end()) {
      lines.push_back(run);
    } else {
      line->add(run);
    }
  }
  std::vector<UprightLine> result;
  for (const Run& run : lines) {
    if (run.pixels >= kLeastPixels) result.push_back(run.line());
  }
  std::ranges::stable_sort(result, {}, &UprightLine::column);
  return result;
}

double WallEdges::levelEdge(int row, int first, int last) const {
  if (row < 0 || row >= levelCount_.rows) return 0.0;
  first = std::clamp(first, 0, levelCount_.cols - 1);
  last = std::clamp(last, 0, levelCount_.cols - 1);
  if (last <= first) return 0.0;
  const auto* count = levelCount_.ptr<int>(row);
  return static_cast<double>(count[last] - count[first]) / (last - first);
}

double WallEdges::density(int first, int last, int top, int bottom) const {
  first = std::clamp(first, 0, edgeCount_.cols - 1);
  last = std::clamp(last, 0, edgeCount_.cols - 1);
  top = std::clamp(top, 0, edgeCount_.rows - 1);
  bottom = std::clamp(bottom, 0, edgeCount_.rows - 1);
  if (last <= first || bottom <= top) return 0.0;
  const int count = edgeCount_.at<int>(bottom, last) - edgeCount_.at<int>(top, last) -
                    edgeCount_.at<int>(bottom, first) + edgeCount_.at<int>(top, first);
  return static_cast<double>(count) / ((last - first) * (bottom - top));
}

double WallEdges::support(const UprightLine& line, int top, int bottom) const {
  top = std::clamp(top, 0, upright_.rows);
  bottom = std::clamp(bottom, 0, upright_.rows);
  int hits = 0;
  for (int row = top; row < bottom; ++row) {
    const auto middle = static_cast<int>(std::lround(line.columnAt(row)));
    bool hit = false;
    for (int column = std::max(0, middle - 1); column <= std::min(upright_.cols - 1, middle + 1); ++column) {
      hit = hit || isUpright(column, row);
    }
    hits += hit ? 1 : 0;
  }
  return bottom > top ? static_cast<double>(hits) / (bottom - top) : 0.0;
}

}  // namespace prodomos::perception
