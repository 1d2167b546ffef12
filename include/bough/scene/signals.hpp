#pragma once
/// Kinds of signals by name, and the order in which signals follow from each other.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/scene/joint_kinds.hpp"

namespace bough::scene {

/// Names as in files.
std::string to_string(SignalKind kind);
std::optional<SignalKind> signal_kind_named(std::string_view name);

/// Whether a signal can have this name: a word of formulas without a meaning of its own (pi, sin, t).
bool is_signal_name(std::string_view name);

/// The coordinate of a joint that a signal reads, or whose rate; nullptr if the joint has no such coordinate.
const JointCoordinate* coordinate_of(const Signal& signal, const JointType& joint);

/// Whether a signal measures a coordinate of a joint, or a point.
bool reads_joint(SignalKind kind);
bool reads_point(SignalKind kind);

/// The highest time derivative of positions on which the present value of each signal depends: 0 positions, 1 rates, 2
/// forces of constraints, -1 none. A state depends on one less than its rate does, since it is integrated.
std::vector<int> levels_of_signals(const Scene& scene);

/// Names of the signals of whose present values a signal is made: its inputs, none for a state, and for an effort the
/// signals that drive it along the coordinate.
std::vector<std::string> present_inputs(const Scene& scene, const Signal& signal);

/// Indices of all signals, each after those of whose present values it is made; a state is made of none. The signals of
/// a circle are missing. An input that is no signal counts as known.
std::vector<std::size_t> order_of_signals(const Scene& scene);

}  // namespace bough::scene
