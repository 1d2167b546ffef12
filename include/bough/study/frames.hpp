#pragma once
/// Accelerations in nested frames over an angle or over time.
#include <utility>
#include <vector>

#include "bough/io/split_table.hpp"
#include "bough/motion/spinning_disc.hpp"
#include "bough/scene/moving_frame.hpp"

namespace bough::study {

/// The disc on a turning shaft over one turn of its spin angle psi. The source gives six pairs of speeds and leaves
/// tilt and radius open; their values here are chosen: 45 degrees, so that axial and transverse parts weigh the same,
/// and 1 m.
struct DiscStudy {
  std::vector<std::pair<double, double>> speeds = {{5, 1}, {4, 2}, {3, 3},
                                                   {2, 4}, {1, 5}, {5, 0}};  ///< psi', phi' [rad/s]
  double tilt_deg = 45.0;  ///< of the disc's axis from the shaft's [degrees]
  double radius = 1.0;     ///< [m]
  int num_points = 361;    ///< of psi from 0 to 360 degrees, both among them; >= 2
};

/// Seen from the inertial frame, in the shaft's axes. One series for each pair of speeds; abscissa psi_deg.
io::SplitTable split_disc(const DiscStudy& study);

/// Over the times of the study; abscissa time. Throws std::runtime_error where a law is not finite, naming it and the
/// time.
io::SplitTable split_frames(const scene::FrameStudy& study);

}  // namespace bough::study
