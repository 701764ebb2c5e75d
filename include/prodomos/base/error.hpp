// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace prodomos::base {

/// What prodomos throws: one line that names the file, the place in it, what was expected and what was found.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that is missing, damaged, of another kind, or cannot be written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// Wrong usage: all faults of a configuration or of a command line at once, one a line.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& fault) : UsageError(std::vector{fault}) {}
  explicit UsageError(std::vector<std::string> faults);

  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::vector<std::string> faults_;
};

/// "PLACE: expected EXPECTED, found FOUND".
std::string expectedFound(const std::string& place, const std::string& expected, const std::string& found);

}  // namespace prodomos::base
