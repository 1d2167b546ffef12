#pragma once
/// Kinds of signals by name, and the order in which signals follow from each other.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/scene/joint_kinds.hpp"

namespace bough::scene {

/// What a signal reads itself, besides other signals.
enum class SignalReads : std::uint8_t { nothing, joint, spring, point, motion };

/// What a signal is told in files besides its name, each by the keys of one entry of the schema.
enum class SignalField : std::uint8_t {
  joint,
  coordinate,
  effort_part,  ///< `of`
  component,
  part,  ///< `of` a prescribed motion or a load, and its `component`
  spring,
  point,  ///< `at` and `axis`
  frame,
  law,
  of,
  table,  ///< `of` two, `x`, `y`, `values`
  expression,
  start,
  nominal,
  unit,
};

struct SignalType {
  SignalKind kind;
  std::string_view name;  ///< in files
  SignalReads reads;
  /// The time derivative of positions that it reads: 0 positions, 1 rates, 2 forces of constraints; -1: none. Of an
  /// effort or a tension it depends on what acts there: the largest.
  int level;
  std::vector<SignalField> fields;
  std::string_view unit;
  std::string_view about;
};

/// All kinds, in the order of the enumeration; then those of files that are made of these.
const std::vector<SignalType>& signal_types();
const SignalType& type_of(SignalKind kind);

/// Names as in files.
std::string to_string(SignalKind kind);
std::optional<SignalKind> signal_kind_named(std::string_view name);

/// Whether a signal can have this name: a word of formulas without a meaning of its own (pi, sin, t).
bool is_signal_name(std::string_view name);

/// The coordinate of a joint that a signal reads, or whose rate; nullptr if the joint has no such coordinate.
const JointCoordinate* coordinate_of(const Signal& signal, const JointType& joint);

/// The row of a joint whose multiplier is a component of its reaction, "fx" to "mz" in the axes of the joint's first
/// frame: the wrench of the first on the second, about the second's origin. The force along axis i belongs to the row
/// u_i = 0, the moment about axis k to the row e_i . R e_j = 0 where R e_j keeps the direction e_j of the first:
///   f_i = -lambda,   m_k = -lambda e_k . (e_j x e_i)
struct ReactionRow {
  int row = -1;       ///< in JointType::rows
  double sign = 1.0;  ///< of the component, times the multiplier
};
/// Nothing where no row holds this component, or where it is no multiplier alone.
std::optional<ReactionRow> reaction_row(const JointType& joint, std::string_view component);
/// Whether a signal of kind joint_effort reads such a component, given as its coordinate.
bool reads_reaction(const Signal& signal);

/// The row of a prescribed motion whose multiplier is a component of its wrench on the part, "fx" to "mz" in the axes of
/// the ground, about the place: `turns` of its rotation, else of its displacement, with the sign of ReactionRow. Nothing
/// where none holds this component alone.
struct ForceRow {
  bool turns = false;
  int row = -1;
  double sign = 1.0;
};
std::optional<ForceRow> force_row(const PrescribedMotion& motion, std::string_view component);

/// Whether a signal measures a coordinate of a joint, or a point.
bool reads_joint(SignalKind kind);
bool reads_point(SignalKind kind);

/// For each signal, whether it reads the multiplier of a row itself: the force of a drive or of what a joint holds.
std::vector<bool> read_rows(const Scene& scene);

/// The highest time derivative of positions on which the present value of each signal depends: 0 positions, 1 rates, 2
/// forces of constraints, -1 none. A state depends on one less than its rate does, since it is integrated.
std::vector<int> levels_of_signals(const Scene& scene);

/// For each signal, the signals of whose present values it is made, as indices: its inputs, none for a state, and for an
/// effort the signals that drive it along the coordinate.
std::vector<std::vector<std::size_t>> present_inputs(const Scene& scene);

/// The unit of each signal: the declared one ("-": a pure number, here empty), otherwise that of what it reads, of its
/// formula from those of its inputs (of a state times s), or of the effort, drive or prescribed motion that it drives.
/// Nothing where none follows: of laws, tables and inputs that drive nothing of these, and of formulas with numbers that
/// have units of their own, as gains have.
std::vector<std::optional<std::string>> units_of_signals(const Scene& scene);

/// Indices of all signals, each after those of whose present values it is made; a state is made of none. The signals of
/// a circle are missing. An input that is no signal counts as known.
std::vector<std::size_t> order_of_signals(const Scene& scene);

}  // namespace bough::scene
