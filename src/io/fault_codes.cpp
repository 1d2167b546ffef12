#include "bough/io/fault_codes.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace bough::io {
namespace {

constexpr FaultCode known_codes[] = {
    {"unreadable", "The file cannot be read."},
    {"not-json", "The text is not JSON."},
    {"encoding", "The text is not UTF-8."},
    {"too-large", "The file, or what it makes, is larger than what is read."},
    {"duplicate-key", "An object has a key twice."},
    {"unknown-key", "An object has a key that is not known there."},
    {"missing-key", "An object lacks a key that it needs."},
    {"conflicting-keys", "Keys or places are given that exclude each other."},
    {"null-value", "null stands where a value is meant."},
    {"not-a-number", "Something else stands where a number is asked for."},
    {"wrong-type", "A value has another type than the one asked for."},
    {"wrong-count", "A list has too many or too few items."},
    {"out-of-range", "A number lies outside of its range."},
    {"not-computable", "A number is too large or too small to be computed with, or not finite."},
    {"unknown-word", "A word is none of those that may stand there."},
    {"bad-name", "A name is not one that a thing may have."},
    {"duplicate-name", "Two things have one name."},
    {"unknown-name", "Nothing has the name that is referred to."},
    {"wrong-reference", "The thing that is referred to is of the wrong kind."},
    {"bad-formula", "A formula cannot be read or computed."},
    {"bad-law", "A law of time or a table cannot be evaluated as it is used."},
    {"circle", "Things follow from each other in a circle."},
    {"geometry", "Places, axes or lengths do not fit together."},
    {"impossible-mass", "A mass, inertia or stiffness belongs to no body."},
    {"analysis", "The analysis does not take this setting."},
    {"velocity", "Initial velocities contradict each other or what holds the parts."},
    {"driven-twice", "One motion is prescribed twice."},
    {"redundant", "Joints repeat each other, so that their reactions are not unique."},
    {"mesh", "A mesh is chosen because none is given."},
    {"left-out", "The model leaves something out that may matter."},
    {"undriven", "A motion is free that the analysis cannot leave free."},
    {"mobility", "Something is locked, loose or without inertia."},
    {"memory", "A run would take more memory than there is."},
    {"no-effect", "A setting or a part changes nothing."},
    {"other-units", "A number looks like one of another unit."},
    {"override", "A setting of the command line cannot be made."},
    {"contradiction", "What is asked for contradicts itself; the message says how."},
};

/// A code and pieces of the texts of rules that belong to it; empty ones are none.
struct Marks {
  std::string_view code;
  std::array<std::string_view, 24> pieces;
};

/// The first row with a piece that a rule holds decides, so what is more particular stands before.
constexpr Marks code_marks[] = {
    {"override", {"override"}},
    {"encoding", {"is UTF-", "is not UTF-8", "zero byte"}},
    {"not-json", {"is not JSON"}},
    {"too-large",
     {"is larger than", "nested deeper", "the file holds more than", "longer than any", "copies", "more than 1e15"}},
    {"unreadable",
     {"there is no such file", "can not be opened", "can not be read", "leads to itself", ", not a file"}},
    {"duplicate-key", {"given before"}},
    {"unknown-key", {"key is not known here"}},
    {"conflicting-keys",
     {"takes only one of the keys", "give one of the two", "leave one of them out", "goes with", "go with",
      "only a screw has", "a follower turns", "has a mass only", "has no common frame", "says its twist",
      "stand in the file"}},
    {"missing-key", {"needs the key", "needs exactly one of the keys", "needs one of the keys", "needs a position"}},
    {"circle", {"in a circle", "stands in itself", "depends on itself", "follow from itself"}},
    {"null-value", {"null is not a value"}},
    {"not-computable",
     {"for a double", "too large to be computed", "numbers are finite", "too large: no digit", "too short to tell",
      "no digit is left"}},
    {"no-effect",
     {"no effect", "does nothing", "do nothing", "is not reached", "no formula uses", "asks for nothing",
      "prescribes nothing", "neither force nor moment", "moves nothing", "so this is 0", "so nothing holds it",
      "analysis ends at", "uses this", "does not turn"}},
    {"mesh", {"the mesh of", "of a mesh that is chosen"}},
    {"left-out", {"is left out"}},
    {"redundant", {"holds the same two things"}},
    {"driven-twice", {"driven twice", "prescribed twice", "both prescribed", "drive one"}},
    {"mobility", {"nothing joins", "nothing here can move"}},
    {"other-units",
     {"of no solid", "is long in a scene", "is a solid", " m thick", "this makes", "is in radians", "is it given in",
      "is it meant", "very large", "radius of gyration", "its mass centre lies", "units are SI", "is asked for in",
      "rad in a step"}},
    {"wrong-type", {"has to be a string", "has to be an object", "has to be a number or"}},
    {"wrong-count", {" items and needs ", "needs one value per", "needs one row per"}},
    {"duplicate-name",
     {"another material has this name", "another measure has this name", "is taken already",
      "a parameter has this name", "has an initial velocity already"}},
    {"bad-name",
     {"a name has", "a name holds", "can not be a name", "by this name", "a name in formulas", "means something else",
      "names no number", "is no unit", "has to name a node"}},
    {"wrong-reference",
     {"this is not a ",
      "not the ground",
      "has no such coordinate",
      "not at an inner node",
      "inner nodes of this beam",
      "has no such",
      "this sensor has the components",
      "without components",
      "no row of a ",
      "the same thing",
      "two rates",
      "has no angle",
      "has the coordinate",
      "no coordinate",
      "which coordinate",
      "takes no moment",
      "has no density",
      "has no such part",
      "holds this coordinate",
      "has the components"}},
    {"unknown-name", {"has this name", "has the name", "there is no ", "the scene has no "}},
    {"bad-law", {"a law is not finite", "this law", "the law jumps", "law of time", "is one of time"}},
    {"analysis", {"statics in a moving frame", "longer than the whole analysis"}},
    {"velocity", {"velocit", "at rest"}},
    {"analysis",
     {"the analysis is static", "integrator", "leave out", "by arc length", "a static analysis", "the penalty",
      "adds a penalty", "load step", "spectral radius", "twins are", "equal steps", "equal size", "former name of"}},
    {"impossible-mass",
     {"definite", "symmetric", "principal moments", "inertia", "mass", "stiffness", "has no volume", "density"}},
    {"geometry",
     {"length 0",
      "length other than 0",
      "coincide",
      " m away",
      " m apart",
      "parallel",
      "perpendicular",
      "right angle",
      "runs along",
      "axis",
      "axes",
      "rotation",
      "quaternion",
      "are turned by",
      "leave this joint",
      "radius",
      "polygon",
      "direction",
      "pitch",
      "outline",
      "crosses",
      "corner",
      "turns by",
      "rad from its start"}},
};

bool has_piece(std::string_view text, std::string_view piece) {
  return !piece.empty() && text.find(piece) != std::string_view::npos;
}

/// The code of a value that "has to be" something else.
std::string_view code_of_wanted(std::string_view rule) {
  const bool is_number = rule.starts_with("has to be a number") || rule.starts_with("has to be a whole number");
  const bool is_other_type = has_piece(rule, ", not a ") || has_piece(rule, ", not an ");
  if (is_other_type) return is_number ? "not-a-number" : "wrong-type";
  if (is_number || has_piece(rule, "above ") || has_piece(rule, "below ") || has_piece(rule, "at least ") ||
      has_piece(rule, "at most "))
    return "out-of-range";
  if (rule.starts_with("has to be \"")) return "unknown-word";
  return {};
}

}  // namespace

std::span<const FaultCode> fault_codes() { return known_codes; }

std::string_view code_of(std::string_view rule, std::string_view pointer) {
  constexpr std::string_view of_formula = "/expression";
  const bool is_formula =
      pointer.size() > of_formula.size() && pointer.substr(pointer.size() - of_formula.size()) == of_formula;
  if (rule.starts_with("has to be "))
    if (const std::string_view code = code_of_wanted(rule); !code.empty()) return code;
  for (const Marks& row : code_marks) {
    const bool fits = std::any_of(row.pieces.begin(), row.pieces.end(),
                                  [&](std::string_view piece) { return has_piece(rule, piece); });
    if (!fits) continue;
    const bool is_of_any_value = row.code == "circle" || row.code == "override" || row.code == "unknown-key" ||
                                 row.code == "missing-key" || row.code == "duplicate-key" || row.code == "null-value" ||
                                 row.code == "not-json" || row.code == "no-effect";
    if (!is_formula || is_of_any_value) return row.code;
  }
  return is_formula ? "bad-formula" : "contradiction";
}

}  // namespace bough::io
