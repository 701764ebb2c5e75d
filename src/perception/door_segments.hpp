// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "perception/rectified_wall.hpp"

#include <opencv2/core.hpp>

#include <cstdint>
#include <vector>

namespace prodomos::perception {

/// An upright line in a wall's image, put together from runs of edge pixels: what a jamb looks like.
struct UprightLine {
  double column = 0.0;     ///< at the height of `middleRow`
  double slope = 0.0;      ///< columns a row
  double middleRow = 0.0;  ///< mean of its edge pixels
  int top = 0;             ///< first and last row
  int bottom = 0;
  int pixels = 0;         ///< rows in which there is an edge pixel
  double contrast = 0.0;  ///< mean difference across it, in the channel that differs most, 0 … 255

  double columnAt(double row) const { return column + slope * (row - middleRow); }
};

/// Edges of a wall's image: colour differences of a pixel's two sides, in the channel that differs most.
class WallEdges {
 public:
  /// Edges are where the difference is at least `contrast`, and greatest across the edge.
  WallEdges(const RectifiedWall& wall, double contrast);

  /// Lines within `tolerance` of the vertical, radians, by column.
  std::vector<UprightLine> uprightLines(double tolerance) const;

  /// Share of the columns [first, last) in which there is a level edge in `row`, or in one beside it.
  double levelEdge(int row, int first, int last) const;
  /// Mean difference across that edge, 0 … 255.
  double levelContrast(int row, int first, int last) const;
  /// Share of edge pixels, upright and level ones, in columns [first, last) and rows [top, bottom).
  double density(int first, int last, int top, int bottom) const;
  /// Share of the rows [top, bottom) in which `line`'s way has an upright edge.
  double support(const UprightLine& line, int top, int bottom) const;
  /// How far edges of a column are blurred, pixels.
  int blurAt(int column) const { return sides_[static_cast<std::size_t>(column)]; }

 private:
  bool isUpright(int column, int row) const { return upright_.at<std::int16_t>(row, column) != 0; }

  std::vector<int> sides_;  ///< per column, how wide edges are there, pixels
  cv::Mat upright_;         ///< CV_16S: signed difference where there is an upright edge, else 0
  cv::Mat down_;            ///< CV_16S: differences downwards
  cv::Mat levelCount_;      ///< CV_32S: level edges (thickened by a row) left of a column in its row
  cv::Mat edgeCount_;       ///< CV_32S: integral image of edge pixels
};

}  // namespace prodomos::perception
