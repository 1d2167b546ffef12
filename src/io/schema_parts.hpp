#pragma once
#include "bough/io/schema_rule.hpp"

namespace bough::io {

/// Rules that several parts of a scene use: vectors, rotations, laws, attachments, matrices, shapes.
void add_part_rules(RuleTable& table);
void add_law_rules(RuleTable& table);
/// Numbers that change with the motion.
void add_signal_rules(RuleTable& table);
/// Statics and dynamics with their step control and paths; `frame`: the field that names the frame of description.
void add_analysis_rules(RuleTable& table, const Field& frame);

/// Measures; also those of sweeps.
void add_measure_rules(RuleTable& table);
/// `parameters` and `repeat`; lists: the lists of a scene of which copies can be made.
void add_expansion_rules(RuleTable& table, const std::vector<Field>& lists);
/// Rules for the number of copies and for the index of the first.
RuleRef copy_count_rule();
RuleRef copy_first_rule();

/// `of` of signals and sensors that read an effort.
Field effort_part_field();

/// An object rule with all its fields; `marker` is the key by which a choice recognises the object.
Rule object_of(Literal about, std::vector<Field> fields, Literal marker = {});
/// An object rule recognised by "kind".
Rule object_of_kind(std::vector<std::string> kinds, Literal about, std::vector<Field> fields);
RuleRef made(Rule rule);

}  // namespace bough::io
