// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

std::string print(TableFormat format) {
  std::string out;
  TableWriter writer([&](const std::string& text) { out += text; }, format, {"t[s]", "region"});
  writer.row({0.1, std::string("far, bank")});
  writer.row({std::nan(""), std::string("a\"b")});
  writer.finish();
  return out;
}

TEST(TableWriter, Tsv) { EXPECT_EQ(print(TableFormat::tsv), "t[s]\tregion\n0.1\tfar, bank\nnan\ta\"b\n"); }
TEST(TableWriter, Csv) { EXPECT_EQ(print(TableFormat::csv), "t[s],region\n0.1,\"far, bank\"\nnan,\"a\"\"b\"\n"); }
TEST(TableWriter, Json) {
  EXPECT_EQ(print(TableFormat::json),
            "[\n{\"t[s]\":0.1,\"region\":\"far, bank\"},\n{\"t[s]\":null,\"region\":\"a\\\"b\"}\n]\n");
}
TEST(TableWriter, JsonWithoutRowsIsAnEmptyArray) {
  std::string out;
  {
    TableWriter writer([&](const std::string& text) { out += text; }, TableFormat::json, {"t[s]"});
  }
  EXPECT_EQ(out, "[]\n");
}

TEST(ReadTable, CommentsUnitsAndGaps) {
  std::istringstream in("# source\nt[s],name,z[m]\n0,a,1.5\n\n1, b ,\n");
  const Table table = parse_table(in, "x.csv");
  EXPECT_EQ(table.row.size(), 2u);
  EXPECT_EQ(table.find("z"), 2u);
  EXPECT_EQ(std::get<std::string>(table.row[1][1]), "b");
  EXPECT_TRUE(std::isnan(table.numbers("z[m]")[1]));
}

TEST(ReadTable, WhatItPrintsItReads) {
  std::istringstream in(print(TableFormat::csv));
  const Table table = parse_table(in, "x.csv");
  EXPECT_EQ(std::get<std::string>(table.row[0][1]), "far, bank");
  EXPECT_EQ(std::get<std::string>(table.row[1][1]), "a\"b");
}

TEST(ReadTable, ErrorsNameFileLineAndColumns) {
  std::istringstream in("a,b\n1,2\n3\n");
  try {
    parse_table(in, "x.csv");
    FAIL() << "no error";
  } catch (const Error& e) { EXPECT_NE(std::string(e.what()).find("x.csv:3"), std::string::npos) << e.what(); }
  std::istringstream good("a[m],b\n1,2\n");
  try {
    parse_table(good, "x.csv").find("c");
    FAIL() << "no error";
  } catch (const Error& e) { EXPECT_NE(std::string(e.what()).find("a[m], b"), std::string::npos) << e.what(); }
}

}  // namespace
}  // namespace gdesp::analysis
