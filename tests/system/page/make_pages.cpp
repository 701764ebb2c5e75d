// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes the pages that page_test.mjs opens: make_pages FOLDER
#include "prodomos/exporter/html.hpp"

#include "support/sample_house.hpp"

#include <filesystem>
#include <iostream>

int main(int argc, char** argv) {
  using namespace prodomos;
  if (argc != 2) {
    std::cerr << "usage: make_pages FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  exporter::writeHtml(test::sampleHouse().view(), folder / "house.html", {});
  exporter::writeHtml(test::sampleHouse().view(), folder / "follow.html", {.followSeconds = 1.0});
  exporter::writeHtml(test::sampleStoreHouse(1000).view(), folder / "large.html", {});
  exporter::writeHtml(map::MapStore::inMemory().view(), folder / "empty.html", {});
  return 0;
}
