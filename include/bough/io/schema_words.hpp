#pragma once
/// What the formats of files say of a word: where it is a key, and where it is a value such as a kind.
#include <string>
#include <string_view>
#include <vector>

namespace bough::io {

struct SchemaEntry {
  std::string format;  ///< "scene", "sweep", "study", "chain of frames" or "motion"
  std::string place;   ///< "springs[].stiffness"; of a value, the key that it stands for: "joints[].kind"
  std::string value;   ///< what may stand there: "number >= 0, required"; of a value, its keys
  std::string about;   ///< sentences with the unit
};

/// All entries of a key or value, made from the tables of rules that check files, or those of a place, as
/// "springs[].stiffness" or the JSON pointer "/springs/0/stiffness".
std::vector<SchemaEntry> schema_entries(std::string_view word);

/// All keys and values that have entries, each once, in the order of the alphabet.
std::vector<std::string> schema_words();

}  // namespace bough::io
