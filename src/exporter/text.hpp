// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace prodomos::exporter {

/// Exactly so many decimals, whatever the locale; never "-0.00".
std::string fixed(double value, int decimals = 6);
/// As fixed(), without the zeros at the end: "1.5", "2".
std::string brief(double value, int decimals = 6);

/// For text and attributes of XML; control characters, which XML 1.0 cannot hold, become '?'.
std::string xml(std::string_view text);
/// In double quotes, for YAML and DOT.
std::string inQuotes(std::string_view text);

/// What `path` names, without the folders that it lies in: exports do not tell whose machine they come from.
std::string fileName(std::string_view path);

}  // namespace prodomos::exporter
