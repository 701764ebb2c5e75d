// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/exporter/html.hpp"

#include "exporter/contents.hpp"
#include "exporter/formats.hpp"
#include "exporter/html_data.hpp"
#include "exporter/text.hpp"
#include "exporter/write_file.hpp"

namespace prodomos::exporter {

/// The page with style, script and Leaflet in it, made from src/exporter/web by embed_page.cmake.
extern const std::string_view kPageTemplate;

namespace {

/// JSON that may stand within <script>: no "<" in it, so neither "</script" nor "<!--".
std::string scriptSafe(const Json& json) {
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char character : text) {
    if (character == '<') {
      safe += "\\u003c";
    } else {
      safe += character;
    }
  }
  return safe;
}

/// Puts `value` where the template says @name@.
void fill(std::string& page, std::string_view name, std::string_view value) {
  const std::string mark = '@' + std::string(name) + '@';
  page.replace(page.find(mark), mark.size(), value);
}

}  // namespace

void writeHtml(const map::MapView& view, const std::filesystem::path& path, const HtmlOptions& options) {
  std::string page(kPageTemplate);
  // The data first: what a log's name brings into the title must not be taken for a mark.
  fill(page, "prodomos_data", scriptSafe(htmlData(view, options)));
  fill(page, "prodomos_title", xml(logNames(view)) + " · prodomos");
  writeFile(path, page);
}

void writeHtml(const map::MapView& view, const Path& path) {
  writeHtml(view, path, HtmlOptions{});
}

}  // namespace prodomos::exporter
