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

/// Pixels on each side of an edge that a difference is taken of, at least.
constexpr int kLeastSide = 2;
constexpr int kMostSide = 8;

/// Per column; where a pixel of the camera covers much of the wall, edges are blurred.
std::vector<int> sidesOf(const RectifiedWall& wall) {
  constexpr double kBlur = 1.3;  // camera pixels
  std::vector<int> sides;
  for (int column = 0; column < wall.width(); ++column) {
    const double pixels = kBlur * wall.footprintAt(wall.xOf(column)) / RectifiedWall::kPixel;
    const int room = std::min(column, wall.width() - 1 - column);
    sides.push_back(std::min(std::clamp(static_cast<int>(std::lround(pixels)), kLeastSide, kMostSide), room));
  }
  return sides;
}

/// In the channel where it is greatest: of the means of `side` pixels on either side.
cv::Mat differencesAcross(const cv::Mat& color, const std::vector<int>& sides) {
  cv::Mat smooth;
  cv::blur(color, smooth, cv::Size(1, 3));
  cv::Mat result(color.size(), CV_16S, cv::Scalar(0));
  std::vector<std::array<int, 3>> sums(static_cast<std::size_t>(color.cols) + 1);
  for (int row = 0; row < color.rows; ++row) {
    const auto* pixel = smooth.ptr<cv::Vec3b>(row);
    for (std::size_t i = 0; i + 1 < sums.size(); ++i) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sums[i + 1][channel] = sums[i][channel] + pixel[i][static_cast<int>(channel)];
      }
    }
    auto* out = result.ptr<std::int16_t>(row);
    for (int column = kLeastSide; column < color.cols - kLeastSide; ++column) {
      const auto at = static_cast<std::size_t>(column);
      const auto side = static_cast<std::size_t>(sides[at]);
      int greatest = 0;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const int difference =
            sums[at + 1 + side][channel] - sums[at + 1][channel] - sums[at][channel] + sums[at - side][channel];
        if (std::abs(difference) > std::abs(greatest)) greatest = difference;
      }
      out[column] = static_cast<std::int16_t>(greatest / sides[at]);
    }
  }
  return result;
}

/// The same downwards.
cv::Mat differencesDown(const cv::Mat& color) {
  cv::Mat smooth;
  cv::blur(color, smooth, cv::Size(3, 1));
  cv::Mat result(color.size(), CV_16S, cv::Scalar(0));
  const auto step = static_cast<std::ptrdiff_t>(smooth.step1());
  for (int row = kLeastSide; row < color.rows - kLeastSide; ++row) {
    const auto* pixel = smooth.ptr<std::uint8_t>(row);
    auto* out = result.ptr<std::int16_t>(row);
    for (int column = 0; column < color.cols; ++column, pixel += 3) {
      int greatest = 0;
      for (int channel = 0; channel < 3; ++channel) {
        const std::uint8_t* at = pixel + channel;
        const int difference = at[step] + at[2 * step] - at[-step] - at[-2 * step];
        if (std::abs(difference) > std::abs(greatest)) greatest = difference;
      }
      out[column] = static_cast<std::int16_t>(greatest / kLeastSide);
    }
  }
  return result;
}

bool isGreatest(const std::int16_t* at, std::ptrdiff_t step, int side) {
  const int size = std::abs(*at);
  for (int i = 1; i <= side; ++i) {
    if (size < std::abs(at[-i * step]) || size <= std::abs(at[i * step])) return false;
  }
  return true;
}

/// Keeps what is at least `contrast` and greatest across the edge. Where the wall is not seen, there is no edge.
cv::Mat thinnedAcross(const cv::Mat& differences, const RectifiedWall& wall, const std::vector<int>& sides,
                      int contrast) {
  cv::Mat result(differences.size(), CV_16S, cv::Scalar(0));
  for (int row = 0; row < differences.rows; ++row) {
    const auto* in = differences.ptr<std::int16_t>(row);
    auto* out = result.ptr<std::int16_t>(row);
    for (int column = kLeastSide; column < differences.cols - kLeastSide; ++column) {
      if (std::abs(in[column]) < contrast || !isVisible(wall.seen(column, row))) continue;
      if (isGreatest(in + column, 1, sides[static_cast<std::size_t>(column)])) out[column] = in[column];
    }
  }
  return result;
}

/// Adds edges that the camera's motion has blurred: those that are much stronger when looked at from afar.
void addSoftEdges(cv::Mat& edges, const cv::Mat& sharp, const RectifiedWall& wall, const std::vector<int>& sides,
                  int contrast) {
  constexpr int kWider = 3;
  std::vector<int> wide = sides;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const auto room = static_cast<int>(std::min(i, wide.size() - 1 - i));
    wide[i] = std::min({kWider * sides[i], kMostSide, room});
  }
  const cv::Mat soft = differencesAcross(wall.color(), wide);
  const cv::Mat thin = thinnedAcross(soft, wall, wide, 2 * contrast);
  for (int row = 0; row < edges.rows; ++row) {
    auto* edge = edges.ptr<std::int16_t>(row);
    const auto* candidate = thin.ptr<std::int16_t>(row);
    const auto* near = sharp.ptr<std::int16_t>(row);
    for (int column = 0; column < edges.cols; ++column) {
      if (std::abs(candidate[column]) > 2 * std::abs(near[column])) edge[column] = candidate[column];
    }
  }
}

cv::Mat thinnedDown(const cv::Mat& differences, const RectifiedWall& wall, int contrast) {
  cv::Mat result(differences.size(), CV_8U, cv::Scalar(0));
  const auto step = static_cast<std::ptrdiff_t>(differences.step1());
  for (int row = kLeastSide; row < differences.rows - kLeastSide; ++row) {
    const auto* in = differences.ptr<std::int16_t>(row);
    auto* out = result.ptr<std::uint8_t>(row);
    for (int column = 0; column < differences.cols; ++column) {
      if (std::abs(in[column]) < contrast || !isVisible(wall.seen(column, row))) continue;
      if (isGreatest(in + column, step, kLeastSide)) out[column] = 255;
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
std::vector<Run> linkRuns(const cv::Mat& upright, const std::vector<int>& sides) {
  constexpr int kGap = 6;           // rows without an edge that a run bridges
  constexpr double kAside = 0.8;    // of an edge's blur, from one pixel to the next
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
      double nearest = kAside * sides[static_cast<std::size_t>(column)];
      for (auto run = std::ranges::lower_bound(open, column - kMostSide, {}, &Run::column);
           run != open.end() && run->column < column + kMostSide; ++run) {
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
bool continues(const Run& a, const Run& b, int blur, double tolerance) {
  const double most = 0.9 * blur;  // columns
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
  return rows > 0.0 && off(above) < most && off(below) < most;
}

}  // namespace

WallEdges::WallEdges(const RectifiedWall& wall, double contrast) : sides_(sidesOf(wall)) {
  const int least = std::max(1, static_cast<int>(contrast));
  const cv::Mat sharp = differencesAcross(wall.color(), sides_);
  upright_ = thinnedAcross(sharp, wall, sides_, least);
  addSoftEdges(upright_, sharp, wall, sides_, least);
  down_ = differencesDown(wall.color());
  const cv::Mat level = thinnedDown(down_, wall, least);
  const cv::Mat isEdge = (upright_ != 0) | level;
  cv::integral(isEdge / 255, edgeCount_, CV_32S);
  cv::Mat thick;
  cv::dilate(level, thick, cv::getStructuringElement(cv::MORPH_RECT, {1, 3}));
  levelCount_ = cv::Mat(thick.rows, thick.cols + 1, CV_32S);
  for (int row = 0; row < thick.rows; ++row) {
    const auto* in = thick.ptr<std::uint8_t>(row);
    auto* out = levelCount_.ptr<int>(row);
    out[0] = 0;
    for (int column = 0; column < thick.cols; ++column) out[column + 1] = out[column] + (in[column] != 0 ? 1 : 0);
  }
}

std::vector<UprightLine> WallEdges::uprightLines(double tolerance) const {
  constexpr int kLeastPixels = 24;
  std::vector<Run> runs = linkRuns(upright_, sides_);
  std::erase_if(runs, [&](const Run& run) { return !leansLess(run, tolerance); });
  // The longest first, so that they gather what continues them.
  std::ranges::stable_sort(runs, std::greater{}, &Run::pixels);
  std::vector<Run> lines;
  for (const Run& run : runs) {
    const double column = run.columns / run.pixels;
    const auto line = std::ranges::find_if(lines, [&](const Run& known) {
      const int blur = blurAt(static_cast<int>(column));
      return std::abs(known.columns / known.pixels - column) < 3.0 * blur && continues(known, run, blur, tolerance);
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

double WallEdges::levelContrast(int row, int first, int last) const {
  first = std::clamp(first, 0, down_.cols);
  last = std::clamp(last, 0, down_.cols);
  if (row < 1 || row + 1 >= down_.rows || last <= first) return 0.0;
  int sum = 0;
  for (int column = first; column < last; ++column) {
    int most = 0;
    for (int i = row - 1; i <= row + 1; ++i) most = std::max<int>(most, std::abs(down_.at<std::int16_t>(i, column)));
    sum += most;
  }
  return static_cast<double>(sum) / (last - first);
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
    const int reach = (blurAt(std::clamp(middle, 0, upright_.cols - 1)) + 1) / 2;
    for (int column = std::max(0, middle - reach); column <= std::min(upright_.cols - 1, middle + reach); ++column) {
      hit = hit || isUpright(column, row);
    }
    hits += hit ? 1 : 0;
  }
  return bottom > top ? static_cast<double>(hits) / (bottom - top) : 0.0;
}

}  // namespace prodomos::perception
