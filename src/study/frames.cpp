#include "bough/study/frames.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bough/io/number_text.hpp"

namespace bough::study {
namespace {

using motion::Vec3;

io::SplitRow row_of(double at, const motion::AccelerationParts& parts, motion::In axes) {
  io::SplitRow row{.at = at};
  const auto set = [&](io::Part part, const motion::Resolved& a) {
    row.parts[static_cast<std::size_t>(part)] = a.components(axes);
  };
  set(io::Part::centripetal, parts.centripetal);
  set(io::Part::razi, parts.razi);
  set(io::Part::coriolis, parts.coriolis);
  set(io::Part::tangential, parts.tangential);
  set(io::Part::local, parts.local);
  set(io::Part::origin, parts.origin);
  set(io::Part::total, parts.total());
  for (std::size_t k = 0; k < row.parts.size(); ++k)
    if (!std::isfinite(row.magnitude(static_cast<io::Part>(k))))
      throw std::runtime_error("the part \"" + std::string(io::part_names[k]) + "\" is too large for a double at " +
                               io::rounded_text(at, 9));
  return row;
}

std::string name_of(const scene::FrameStudy& study, int frame) {
  return frame == 0 ? "ground" : study.frames.at(static_cast<std::size_t>(frame) - 1).name;
}

motion::PointMotion point_at(const scene::FrameStudy& study, double t) {
  motion::PointMotion p{.frame = study.point_frame};
  for (int k = 0; k < 3; ++k) {
    const laws::LawValue x = study.point[k].at(t);
    if (const auto fault = laws::non_finite(x))
      throw std::runtime_error(std::string("position ") + "xyz"[k] + " of the point: " + *fault +
                               " at t = " + io::rounded_text(t, 9) + " s");
    p.position[k] = x.value;
    p.velocity[k] = x.rate;
    p.acceleration[k] = x.acceleration;
  }
  return p;
}

}  // namespace

io::SplitTable split_disc(const DiscStudy& study) {
  const motion::In shaft(1);
  io::SplitTable table{.title = "Point of a disc that spins on a turning shaft",
                       .abscissa = "psi_deg",
                       .seen_from = "ground",
                       .axes = "shaft",
                       .columns = {io::Part::centripetal, io::Part::razi, io::Part::coriolis, io::Part::tangential,
                                   io::Part::local, io::Part::total},
                       .series = {}};
  for (const auto& [spin, precession] : study.speeds) {
    const motion::SpinningDisc disc{spin, precession, study.tilt_deg * (std::numbers::pi / 180.0), study.radius};
    io::SplitSeries series{
        {{"spin", spin}, {"precession", precession}, {"tilt_deg", study.tilt_deg}, {"radius", study.radius}}, {}};
    for (int k = 0; k < study.num_points; ++k) {
      const double psi_deg = 360.0 * k / (study.num_points - 1);
      const motion::FrameChain chain = motion::chain_of(disc, psi_deg * (std::numbers::pi / 180.0));
      series.rows.push_back(
          row_of(psi_deg, motion::acceleration_split(chain, motion::point_of(disc), motion::From(0), shaft), shaft));
    }
    table.series.push_back(std::move(series));
  }
  return table;
}

io::SplitTable split_frames(const scene::FrameStudy& study) {
  io::SplitTable table{.title = study.title.empty() ? study.name : study.title,
                       .abscissa = "time",
                       .seen_from = name_of(study, study.from),
                       .axes = name_of(study, study.in),
                       .columns = {io::Part::centripetal, io::Part::razi, io::Part::coriolis, io::Part::tangential,
                                   io::Part::local, io::Part::origin, io::Part::total},
                       .series = {io::SplitSeries{}}};
  motion::FrameChain chain(std::vector<motion::FrameMotion>(study.frames.size()));
  const motion::In axes(study.in);
  for (int k = 0; k < study.num_points; ++k) {
    const double t = scene::time_of(study, k);
    for (int i = 1; i <= chain.last(); ++i) {
      const scene::MovingFrame& frame = study.frames[static_cast<std::size_t>(i) - 1];
      if (const auto fault = scene::non_finite_law(frame, t))
        throw std::runtime_error(*fault + " at t = " + io::rounded_text(t, 9) + " s");
      chain.set_link(i, scene::motion_at(frame, t));
    }
    table.series[0].rows.push_back(
        row_of(t, motion::acceleration_split(chain, point_at(study, t), motion::From(study.from), axes), axes));
  }
  return table;
}

}  // namespace bough::study
