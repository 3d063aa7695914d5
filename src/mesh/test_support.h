// What the tests of the mesh readers share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "mesh/error.h"
#include "mesh/mesh.h"

namespace accuray::mesh {

// Checks every promise of MeshData.
inline void expect_valid(const MeshData& mesh) {
  ASSERT_EQ(mesh.positions.size() % 3, 0u);
  ASSERT_EQ(mesh.indices.size() % 3, 0u);
  size_t vertices = mesh.positions.size() / 3;
  ASSERT_TRUE(mesh.normals.empty() || mesh.normals.size() == 3 * vertices);
  ASSERT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == 2 * vertices);
  for (uint32_t index : mesh.indices) ASSERT_LT(index, vertices);
  for (float x : mesh.positions) ASSERT_LE(std::fabs(x), kMaxCoordinate);
  for (float x : mesh.uvs) ASSERT_TRUE(std::isfinite(x));
  ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == 4 * vertices);
  for (float x : mesh.colors) ASSERT_TRUE(std::isfinite(x));
  for (size_t i = 0; i < mesh.normals.size(); i += 3) {
    ASSERT_NEAR(std::hypot(mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]), 1.0, 1e-6);
  }
  const MeshReport& report = mesh.report;
  ASSERT_EQ(mesh.indices.size() / 3 + report.nonfinite_triangles + report.degenerate_triangles, report.triangles_read);
}

// Checks that `read` throws a ReadError whose message is `message`.
inline void expect_error(const std::function<MeshData()>& read, const std::string& message) {
  try {
    read();
    ADD_FAILURE() << "no error; expected " << message;
  } catch (const ReadError& error) {
    EXPECT_EQ(error.what(), message);
  }
}

// A copy of `text` with one to four small random injuries: a byte changed, a piece removed, repeated or overwritten by
// one of `tokens`, or the end cut off.
inline std::string mutate(std::string text, const std::vector<std::string>& tokens, std::mt19937& random) {
  auto below = [&](size_t n) { return n == 0 ? 0 : random() % n; };
  for (size_t injuries = 1 + below(4); injuries > 0; --injuries) {
    size_t at = below(text.size() + 1), size = below(12);
    switch (below(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, size);
        break;
      case 2:
        text.insert(below(text.size() + 1), text.substr(at, 4 * size));
        break;
      case 3:
        text.replace(at, size, tokens[below(tokens.size())]);
        break;
      default:
        if (below(4) == 0) text.resize(at);
    }
  }
  return text;
}

// Reads `count` mutants: each must give a valid mesh or a ReadError, and some must do either.
inline void survive_mutants(const std::vector<std::string>& seeds, const std::vector<std::string>& tokens, int count,
                            const std::function<MeshData(const std::string&)>& read) {
  std::mt19937 random(20240613);
  int good = 0;
  for (int i = 0; i < count; ++i) {
    std::string text = mutate(seeds[static_cast<size_t>(i) % seeds.size()], tokens, random);
    try {
      expect_valid(read(text));
      ++good;
    } catch (const ReadError& error) {
      ASSERT_NE(std::string(error.what()).find(": allowed "), std::string::npos);
    }
    if (testing::Test::HasFatalFailure()) FAIL() << "mutant " << i << ":\n" << text;
  }
  EXPECT_GT(good, count / 20);
  EXPECT_LT(good, count - count / 20);
}

// Reads every beginning of a file, and the file with each of its bytes replaced by others: each must give a valid mesh
// or a ReadError.
inline void survive_sweeps(const std::string& file, const std::function<MeshData(const std::string&)>& read) {
  auto attempt = [&](const std::string& text) {
    try {
      expect_valid(read(text));
    } catch (const ReadError&) {
    }
  };
  for (size_t at = 0; at < file.size() && !testing::Test::HasFatalFailure(); ++at) {
    attempt(file.substr(0, at));
    for (char byte : {'\0', '\xff', '9', '-', '\n', static_cast<char>(file[at] ^ 1)}) {
      std::string changed = file;
      changed[at] = byte;
      attempt(changed);
    }
  }
}

}  // namespace accuray::mesh
