// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

/// Drawing in SVG; colours are those of the page, by classes.
namespace prodomos::evaluation {

/// Exactly so many decimals, whatever the locale; never "-0.00".
std::string fixed(double value, int decimals);

/// For text and attributes of HTML and SVG.
std::string escaped(std::string_view text);

/// Shapes in pixels, y down.
class Svg {
 public:
  using Points = std::vector<Eigen::Vector2d>;

  /// Shapes that follow are one group, until close().
  void open(std::string_view mark);
  void close();
  /// `title` is shown when one points at it; may be empty. `style` is CSS.
  void polygon(const Points& corners, std::string_view mark, std::string_view title = {}, std::string_view style = {});
  void polyline(const Points& points, std::string_view mark, std::string_view title = {});
  void circle(const Eigen::Vector2d& middle, double radius, std::string_view mark, std::string_view title = {});
  void text(const Eigen::Vector2d& at, std::string_view text, std::string_view mark);

  /// One <svg> element of that size.
  std::string str(double width, double height, std::string_view name) const;

 private:
  void add(std::string_view element, const std::string& attributes, std::string_view mark, std::string_view title);

  std::string body_;
};

}  // namespace prodomos::evaluation
