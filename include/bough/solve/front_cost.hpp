#pragma once
/// Times of the work on fronts [s], by which lanes and renewals of factorizations are decided. They are fitted to
/// single factorizations and solutions of the scenes of data/ on one machine; on others only their ratios matter.
namespace bough::solve::front_cost {

// Elimination of eight fronts in lockstep, of whatever number of lanes in use.
constexpr double per_pack = 3.5e-7, per_flop_of_pack = 4.4e-10;
// Elimination of one front, per eliminated column, per entry of its panels, and per flop.
constexpr double per_column = 5.5e-8, per_panel = 3.1e-9, per_flop = 1.4e-11;
// A solution: per front that is eliminated by itself, and per byte of the factor in the caches.
constexpr double per_front_solved = 1.3e-7, per_byte_solved = 3.3e-11;

}  // namespace bough::solve::front_cost
