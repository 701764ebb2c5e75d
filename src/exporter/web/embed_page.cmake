# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause

# Makes one C++ file from the parts of the web page:
#   cmake -D WEB=src/exporter/web -D LEAFLET=/usr/share/javascript/leaflet -D OUT=page.cpp -P embed_page.cmake

function(read file variable)
  file(READ "${file}" text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

function(put mark text)
  string(FIND "${page}" "@${mark}@" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "page.html: expected a mark @${mark}@, found none")
  endif()
  string(REPLACE "@${mark}@" "${text}" page "${page}")
  set(page "${page}" PARENT_SCOPE)
endfunction()

read("${LEAFLET}/leaflet.min.js" leaflet_js)
read("${LEAFLET}/leaflet.css" leaflet_css)
read("${WEB}/leaflet-license.txt" leaflet_license)
read("${WEB}/page.css" page_css)
read("${WEB}/page.html" page)

# Nothing in the page names another file: no pictures of Leaflet's (not used here), no source map.
string(REGEX REPLACE "url\\([^)]*\\)" "none" leaflet_css "${leaflet_css}")
string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" leaflet_js "${leaflet_js}")
string(REGEX REPLACE "/[*]# sourceMappingURL=[^\n]*" "" leaflet_css "${leaflet_css}")

set(page_js "(() => {\n'use strict';\n")
foreach(part data palette scene panel page)
  read("${WEB}/${part}.js" script)
  string(APPEND page_js "${script}\n")
endforeach()
string(APPEND page_js "})();")

put(leaflet_license "${leaflet_license}")
put(leaflet_css "${leaflet_css}")
put(page_css "${page_css}")
put(leaflet_js "${leaflet_js}")
put(page_js "${page_js}")

file(WRITE "${OUT}" "#include <string_view>
namespace prodomos::exporter {
extern const std::string_view kPageTemplate;
const std::string_view kPageTemplate = R\"page~(${page})page~\";
}  // namespace prodomos::exporter
")
