// The tables of offsets in a page of the documentation.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <map>
#include <sstream>
#include <string>

namespace cellmirror::test {

struct DocumentedRow {
  std::size_t offset = 0;
  std::string type;
};
using DocumentedTable = std::map<std::string, DocumentedRow>;  // by name

// The table behind the heading "### `title`" of docs/`page`.
inline DocumentedTable documented(const std::string& page, const std::string& title) {
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  std::ifstream in(std::string(source == nullptr ? "." : source) + "/docs/" + page);
  EXPECT_TRUE(in) << "docs/" << page << " is missing; CELLMIRROR_SOURCE_DIR names the sources";
  DocumentedTable table;
  std::string line;
  bool here = false;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) here = line == "### " + title;
    // "| offset | type | name | ..."; the heading and the rule below it begin otherwise.
    std::istringstream words(here ? line : "");
    std::size_t offset = 0;
    std::string bar[4];
    std::string type;
    std::string name;
    if (words >> bar[0] >> offset >> bar[1] >> type >> bar[2] >> name >> bar[3] && bar[3] == "|") {
      table[name] = {offset, type};
    }
  }
  return table;
}

struct DocumentedField {
  const char* name;
  const char* type;
  std::size_t codec;
  std::size_t in_struct;
  std::size_t macro;
};

// Documentation, codec, C struct and C macro tell the same of all fields, and there are no others.
inline void expect_agreement(const std::string& page, const std::string& title,
                             std::initializer_list<DocumentedField> fields) {
  const DocumentedTable table = documented(page, title);
  EXPECT_EQ(table.size(), fields.size()) << title;
  for (const DocumentedField& field : fields) {
    const auto row = table.find(field.name);
    ASSERT_NE(row, table.end()) << title << ": " << field.name << " is not documented";
    EXPECT_EQ(row->second.offset, field.codec) << title << ": " << field.name;
    EXPECT_EQ(row->second.type, field.type) << title << ": " << field.name;
    EXPECT_EQ(field.in_struct, field.codec) << title << ": " << field.name;
    EXPECT_EQ(field.macro, field.codec) << title << ": " << field.name;
  }
}

}  // namespace cellmirror::test
