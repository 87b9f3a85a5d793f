#include "shallow_sand/sim/simulator.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/sim/engine.h"
#include "shallow_sand/sim/sand_contacts.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {

namespace {

Vector3 toVector3(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

void checkField(const std::string& key, const std::vector<float>& values, const Grid& grid, float least) {
  if (values.size() != grid.cells()) {
    throw InvalidParameter(key, std::to_string(values.size()) + " values",
                           std::to_string(grid.cells()) + ", one for each cell");
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const float value = values[grid.index(i, j)];
      if (std::isfinite(value) && value >= least) continue;
      std::ostringstream found;
      found << value << " in cell (" << i << ", " << j << ")";
      throw InvalidParameter(key, found.str(),
                             least < 0.0f ? "finite metres" : "finite metres that are not negative");
    }
  }
}

void checkMaterial(const MaterialFields& fields, Material material, const Grid& grid) {
  const auto check = [&](const char* key, const std::vector<float>& values, double Material::*member) {
    if (values.empty()) return;
    if (values.size() != grid.cells()) {
      throw InvalidParameter(key, std::to_string(values.size()) + " values",
                             "none or " + std::to_string(grid.cells()) + ", one for each cell");
    }
    for (const float value : values) {
      material.*member = value;
      material.validate();
    }
  };
  check("material.friction_angle", fields.friction_angle, &Material::friction_angle);
  check("material.dilute_layer.fraction", fields.layer_fraction, &Material::layer_fraction);
  check("material.dilute_layer.depth", fields.layer_depth, &Material::layer_depth);
}

/// Holds a number of a new material to what there is where a map gives it. @param unit to tell it in
void requireUnlessMapped(const char* key, const std::vector<float>& map, double now, double wanted,
                         double unit) {
  if (map.empty() || wanted == now) return;
  std::ostringstream found;
  std::ostringstream expected;
  found << wanted / unit;
  expected << now / unit << " as it is, for a map gives it cell by cell";
  throw InvalidParameter(key, found.str(), expected.str());
}

/// From one pose to another; of a rotation by nothing, roundings would make an axis.
Eigen::AngleAxisd turnBetween(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  if (to.linear() == from.linear()) return Eigen::AngleAxisd::Identity();
  return Eigen::AngleAxisd(to.linear() * from.linear().transpose());
}

double sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

struct ChosenBackend {
  Backend backend;
  int threads;
  std::string notice;
};

ChosenBackend onCpu(int threads, const std::string& why) {
  threads = threads > 0 ? threads : omp_get_max_threads();
  return {Backend::cpu, threads, why + "running on the CPU with " + std::to_string(threads) + " threads"};
}

/// The CPU, if that is an answer to what was asked for.
ChosenBackend withoutGpu(Backend wanted, int threads, const std::string& reason) {
  if (wanted == Backend::cuda)
    throw InvalidParameter("backend", "cuda, but " + reason, "auto or cpu on this machine");
  return onCpu(threads, "no usable GPU (" + reason + "): ");
}

ChosenBackend chooseBackend(Backend wanted, int threads) {
  if (wanted == Backend::cpu) return onCpu(threads, "");
#ifdef SHALLOW_SAND_WITH_CUDA
  const std::string reason = cudaUnavailable();
  if (reason.empty()) return {Backend::cuda, 1, "running on the GPU: " + cudaDeviceName()};
#else
  const std::string reason = "this build has no CUDA (see SHALLOW_SAND_CUDA in the README)";
#endif
  return withoutGpu(wanted, threads, reason);
}

}  // namespace

std::string toString(Backend backend) {
  switch (backend) {
    case Backend::cpu:
      return "cpu";
    case Backend::cuda:
      return "cuda";
    default:
      return "auto";
  }
}

Backend backendFromString(const std::string& name) {
  for (const Backend backend : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    if (name == toString(backend)) return backend;
  }
  throw InvalidParameter("backend", name, "auto, cpu or cuda");
}

void SimulatorParameters::validate() const {
  grid.validate();
  validateGravity(gravity);
  material.validate();
  solver.validate();
  if (grains) grains->validate(grid.grid());
  if (threads < 0 || threads > 4096) {
    throw InvalidParameter("threads", std::to_string(threads), "0 (all) or a number up to 4096");
  }
}

double Ledger::error() const {
  const double came = start + poured;
  return came > 0.0 ? std::abs(now - (came - left)) / came : 0.0;
}

Snapshot withoutBodies(Snapshot snapshot) {
  Fields& fields = snapshot.fields;
  const auto lay = [](std::vector<float>& load, std::vector<float>& ground) {
    for (std::size_t k = 0; k < load.size(); ++k) ground[k] += load[k];
    load.clear();
  };
  lay(fields.load, fields.depth);
  lay(fields.load_momentum_x, fields.momentum_x);
  lay(fields.load_momentum_y, fields.momentum_y);
  fields.load_elevation.clear();
  snapshot.contacts = {};
  return snapshot;
}

class Simulator::Implementation {
 public:
  struct Body {
    std::string name;
    std::shared_ptr<const DistanceField> field;
    Motion motion;
    double reach;  // of its farthest point from its origin [m]
    // Where and when it was placed the last time; the time is infinite if it never was.
    Eigen::Isometry3d placed_at = Eigen::Isometry3d::Identity();
    double placed_time = std::numeric_limits<double>::infinity();
    int still = 0;  // placements before that in which it was just there, without a gap
  };

  Implementation(const SimulatorParameters& parameters, std::vector<float> bed, std::vector<float> depth,
                 const MaterialFields& material)
      : parameters_(parameters), material_fields_(material) {
    parameters_.validate();
    grid_ = parameters_.grid.grid();
    checkField("bed", bed, grid_, -std::numeric_limits<float>::infinity());
    checkField("depth", depth, grid_, 0.0f);
    checkMaterial(material, parameters_.material, grid_);
    start_volume_ = sum(depth) * grid_.cellArea();
    chosen_ = chooseBackend(parameters_.backend, parameters_.threads);

    EngineStart start;
    start.grid = grid_;
    start.sand = sandConstants(grid_, parameters_.gravity, parameters_.material);
    const auto open = [](Edge edge) { return edge == Edge::open; };
    const Edges& edges = parameters_.edges;
    start.open = {open(edges.x_min), open(edges.x_max), open(edges.y_min), open(edges.y_max)};
    const std::vector<float> rest(grid_.cells(), 0.0f);
    start.fields = {std::move(bed), std::move(depth), rest, rest};
    start.material = localMaterial(parameters_.material, material, grid_);
    start.displacement = displaces();
    start.with_slopes = parameters_.solver.reconstruction == Reconstruction::minmod;
    start.grains = parameters_.grains;
#ifdef SHALLOW_SAND_WITH_CUDA
    if (chosen_.backend == Backend::cuda) {
      try {
        engine_ = makeCudaEngine(start, cudaStepsAtOnce(grid_));
      } catch (const std::runtime_error& reason) {
        chosen_ = withoutGpu(parameters_.backend, parameters_.threads, reason.what());
      }
    }
#endif
    if (!engine_) {
      engine_ = makeHostEngine(start, chosen_.threads, parameters_.sleeping, instructions());
    }
  }

  bool displaces() const { return parameters_.coupling == Coupling::displacement; }
  InstructionSet instructions() const { return parameters_.instructions.value_or(instructionSets().back()); }

  void addPour(const Pour& pour) {
    pour.validate();
    requireOnGrid("position", pour.position);
    Region region;
    region.center = pour.position;
    region.radius = pour.radius;
    finish();
    engine_->addPour(localRegion(region, grid_), {pour.start, pour.stop, pour.rate});
  }

  void requireOnGrid(const char* key, const Eigen::Vector2d& position) const {
    const Eigen::Vector2d local = position - Eigen::Vector2d(grid_.origin_x, grid_.origin_y);
    const Eigen::Vector2d size = grid_.spacing * Eigen::Vector2d(grid_.columns, grid_.rows);
    if ((local.array() >= 0.0).all() && (local.array() <= size.array()).all()) return;
    std::ostringstream found;
    found << "[" << position.x() << ", " << position.y() << "]";
    throw InvalidParameter(key, found.str(), "a place on the grid");
  }

  void setMaterial(const Material& material) {
    material.validate();
    const Material& now = parameters_.material;
    requireUnlessMapped("material.friction_angle", material_fields_.friction_angle, now.friction_angle,
                        material.friction_angle, M_PI / 180.0);
    requireUnlessMapped("material.dilute_layer.fraction", material_fields_.layer_fraction, now.layer_fraction,
                        material.layer_fraction, 1.0);
    requireUnlessMapped("material.dilute_layer.depth", material_fields_.layer_depth, now.layer_depth,
                        material.layer_depth, 1.0);
    finish();
    parameters_.material = material;
    sendSand();
  }

  void setGravity(const Eigen::Vector3d& gravity) {
    validateGravity(gravity);
    finish();
    parameters_.gravity = gravity;
    sendSand();
  }

  /// Material and gravity as they are now.
  void sendSand() {
    engine_->setSand(sandConstants(grid_, parameters_.gravity, parameters_.material),
                     localMaterial(parameters_.material, material_fields_, grid_));
  }

  double edit(const Edit& edit) {
    edit.validate();
    finish();
    const LocalRegion region = localRegion(edit.region, grid_);
    if (windowOf(region, grid_).empty()) requireOnGrid("center", edit.region.center);
    expectSand(region);
    return engine_->edit(region, edit.operation, static_cast<float>(edit.value));
  }

  double setSand(EditOperation operation, const CellValues& cells) {
    const std::vector<float> values = valuesToSet(operation, cells);
    finish();
    expectSand(wholeMap());
    return engine_->edit(operation, values);
  }

  /// NaN for cells that keep their sand.
  std::vector<float> valuesToSet(EditOperation operation, const CellValues& cells) const {
    const float any = -std::numeric_limits<float>::infinity();
    if (operation != EditOperation::set && operation != EditOperation::level)
      throw InvalidParameter("operation", "neither set nor level", "one of the two");
    if (cells.given.size() != grid_.cells()) {
      throw InvalidParameter("given", std::to_string(cells.given.size()) + " values",
                             std::to_string(grid_.cells()) + ", one for each cell");
    }
    std::vector<float> values = cells.values;
    const auto replaceOthers = [&](float value) {
      for (std::size_t k = 0; k < std::min(values.size(), cells.given.size()); ++k)
        values[k] = cells.given[k] == 0 ? value : values[k];
    };
    replaceOthers(0.0f);
    checkField("values", values, grid_, operation == EditOperation::set ? 0.0f : any);
    replaceOthers(std::numeric_limits<float>::quiet_NaN());
    return values;
  }

  /// Before sand comes or goes in a region.
  void expectSand(const LocalRegion& region) {
    if (!bodies_.empty() && displaces()) {
      // A body that hangs high above the sand catches what comes down now.
      engine_->expectSand(region);
      placeBodies();
    }
    // Sand may have come to lie where a body is.
    placed_anew_ = placed_anew_ || !bodies_.empty();
  }

  /// What only looks, too, has to wait for a run that was begun.
  Snapshot snapshot() {
    Snapshot snapshot;
    snapshot.fields = fields();
    snapshot.contacts = engine_->contacts();
    snapshot.bodies_cleared = !placed_anew_;
    snapshot.time = time_;
    snapshot.next_step = trial_;
    snapshot.progress = progress_;
    snapshot.ledger = figures().ledger;
    snapshot.grains = grains();
    return snapshot;
  }

  void restore(const Snapshot& snapshot) {
    finish();
    requireFit(snapshot);
    Fields fields = snapshot.fields;
    // Saved when there was no body yet.
    if (!bodies_.empty() && fields.load.empty()) fields.addLoads();
    for (std::vector<float>* momentum :
         {&fields.momentum_x, &fields.momentum_y, &fields.load_momentum_x, &fields.load_momentum_y}) {
      // Negative zeros would be bits that a step changes.
      for (float& value : *momentum) value += 0.0f;
    }
    engine_->restore(fields, snapshot.contacts);
    placed_anew_ = !snapshot.bodies_cleared;
    time_ = snapshot.time;
    restoreGrains(fields, snapshot.grains);
    notePlaced(instantAt(time_, nullptr));
    for (Body& body : bodies_) body.still = 0;
    steps_since_placed_ = 0;
    trial_ = snapshot.next_step;
    progress_ = snapshot.progress;
    start_volume_ = snapshot.ledger.start;
    poured_before_ = snapshot.ledger.poured - engine_->poured();
    left_before_ = snapshot.ledger.left - engine_->left();
  }

  void requireFit(const Snapshot& snapshot) const {
    const float any = -std::numeric_limits<float>::infinity();
    checkField("bed", snapshot.fields.bed, grid_, any);
    checkField("depth", snapshot.fields.depth, grid_, 0.0f);
    checkField("momentum_x", snapshot.fields.momentum_x, grid_, any);
    checkField("momentum_y", snapshot.fields.momentum_y, grid_, any);
    if (!std::isfinite(snapshot.time))
      throw InvalidParameter("time", std::to_string(snapshot.time), "finite seconds");
    if (!(snapshot.next_step > 0.0))
      throw InvalidParameter("next_step", std::to_string(snapshot.next_step), "positive seconds");
    const Ledger& ledger = snapshot.ledger;
    for (const double volume : {ledger.start, ledger.poured, ledger.left}) {
      if (!(volume >= 0.0 && std::isfinite(volume)))
        throw InvalidParameter("ledger", std::to_string(volume), "finite cubic metres that are not negative");
    }
    requireFit(snapshot.fields, snapshot.contacts);
    requireFit(snapshot.grains);
  }

  void requireFit(const Grains& grains) const {
    if (grains.cells.empty()) return;
    const std::size_t count =
        parameters_.grains ? static_cast<std::size_t>(GrainGrid(*parameters_.grains, grid_).cells()) : 0;
    if (grains.cells.size() != count)
      throw InvalidParameter("grains", std::to_string(grains.cells.size()),
                             std::to_string(count) + " or none");
    const auto isValid = [count](const Grain& grain) {
      return grain.x >= 0.0f && grain.x < 1.0f && grain.y >= 0.0f && grain.y < 1.0f &&
             (grain.origin & ~Grain::kBare) < count;
    };
    if (!std::all_of(grains.cells.begin(), grains.cells.end(), isValid))
      throw InvalidParameter("grains", "a grain outside of its cell", "offsets from 0 to less than 1");
  }

  void restoreGrains(const Fields& fields, const Grains& grains) {
    if (!parameters_.grains) return;
    const bool anew = grains.cells.empty();
    engine_->setGrains(anew ? startingGrains(GrainGrid(*parameters_.grains, grid_), grid_, fields)
                            : grains.cells);
    grain_moves_ = grains.moves;
    grains_moved_until_ = time_;
  }

  void requireFit(const Fields& fields, const ContactSnapshot& contacts) const {
    if (bodies_.empty() && !(contacts.windows.empty() && fields.load.empty()))
      throw InvalidParameter("contacts", "those of bodies", "none, for there are no bodies");
    const float any = -std::numeric_limits<float>::infinity();
    if (!fields.load.empty()) {
      checkField("load", fields.load, grid_, 0.0f);
      checkField("load_elevation", fields.load_elevation, grid_, any);
      checkField("load_momentum_x", fields.load_momentum_x, grid_, any);
      checkField("load_momentum_y", fields.load_momentum_y, grid_, any);
    }
    if (contacts.windows.empty()) return;
    const Window all = Window::all(grid_);
    for (const Window& window : contacts.windows) {
      if (window.united(all).cells() != all.cells())
        throw InvalidParameter("contacts", "a window that reaches beyond the grid", "one on the grid");
    }
    for (const auto* values : {&contacts.clearance, &contacts.headroom, &contacts.cover, &contacts.length,
                               &contacts.velocity_x, &contacts.velocity_y, &contacts.velocity_z}) {
      const bool valid =
          values->size() == grid_.cells() &&
          std::none_of(values->begin(), values->end(), [](float value) { return std::isnan(value); });
      if (!valid)
        throw InvalidParameter("contacts", "a bad list", std::to_string(grid_.cells()) + " numbers");
    }
  }

  void addBody(const std::string& name, std::shared_ptr<const DistanceField> field) {
    finish();
    engine_->addBody(*field);
    const Eigen::Vector3d far_corner(field->samples[0] - 1, field->samples[1] - 1, field->samples[2] - 1);
    const Eigen::Vector3d opposite = field->origin + field->spacing * far_corner;
    const double reach = field->origin.cwiseAbs().cwiseMax(opposite.cwiseAbs()).norm();
    bodies_.push_back({name, std::move(field), Motion(), reach});
  }

  Body& present(std::size_t body) {
    if (body < bodies_.size() && bodies_[body].field != nullptr) return bodies_[body];
    throw InvalidParameter("body", std::to_string(body), "the number of a body that was not removed");
  }

  void placeBody(std::size_t body, const Eigen::Isometry3d& pose) {
    finish();
    Motion motion;
    appendTo(motion, present(body).name, time_, pose);
    present(body).motion = motion;
    present(body).placed_time = std::numeric_limits<double>::infinity();
    placed_anew_ = true;
  }

  void removeBody(std::size_t body) {
    finish();
    present(body).motion = Motion();
    present(body).field.reset();
    engine_->removeBody(body);
    placed_anew_ = true;
  }

  static void appendTo(Motion& motion, const std::string& body, double time, const Eigen::Isometry3d& pose) {
    try {
      motion.append(time, pose);
    } catch (const InvalidParameter& problem) {
      throw InvalidParameter("body " + body, problem.what(), "a valid pose");
    }
  }

  void appendPose(std::size_t body, double time, const Eigen::Isometry3d& pose) {
    finish();
    Body& moved = present(body);
    placed_anew_ = placed_anew_ || moved.motion.empty();
    appendTo(moved.motion, moved.name, time, pose);
    moved.motion.forgetBefore(time_);
  }

  void beginAdvanceTo(double end) {
    finish();
    if (!(end >= time_) || !std::isfinite(end)) {
      throw InvalidParameter("time", std::to_string(end),
                             "finite seconds, not before " + std::to_string(time_) + " s, which it is");
    }
    if (placed_anew_) placeBodies();
    placed_anew_ = false;
    end_ = end;
    if (time_ < end_) startRun();
  }

  /// Waits until the sand is where it was to be advanced to.
  void finish() {
    while (runs_) {
      const StepRun run = engine_->finish();
      runs_ = false;
      take(run);
      if (time_ < end_) startRun();
    }
    moveGrains();
  }

  /// Grains go on for as long as the sand has since they did the last time.
  void moveGrains() {
    if (!parameters_.grains || !(time_ > grains_moved_until_)) return;
    engine_->moveGrains(static_cast<float>(time_ - grains_moved_until_), ++grain_moves_);
    grains_moved_until_ = time_;
  }

  Grains grains() {
    finish();
    if (!parameters_.grains) return {};
    Grains grains(*parameters_.grains, grid_);
    grains.moves = grain_moves_;
    grains.cells = engine_->grains();
    return grains;
  }

  /// Takes steps until `end_`, or as far as a list of placements goes.
  void startRun() {
    const SolverParameters& solver = parameters_.solver;
    StepRun run{};
    run.bounds = {solver.courant * grid_.spacing, solver.max_step, solver.fixed_step.value_or(0.0)};
    run.end = end_;
    run.displacement = displaces();
    run.most_steps = std::numeric_limits<std::uint64_t>::max();
    run.time = time_;
    run.trial = trial_;
    run.placement = -1;
    run.steps_since_placed = steps_since_placed_;
    run.progress = progress_;
    schedule();
    engine_->start(run, placementsOf(schedule_));
    runs_ = true;
  }

  void take(const StepRun& run) {
    time_ = run.time;
    trial_ = run.trial;
    progress_ = run.progress;
    steps_since_placed_ = run.steps_since_placed;
    if (run.placement >= 0) notePlaced(schedule_[static_cast<std::size_t>(run.placement)]);
    if (run.too_long_for > 0.0) requireShorterStep(run.too_long_for);
  }

  /// Where all bodies are at a time; those without a pose are anywhere.
  struct Instant {
    double time;
    std::vector<Eigen::Isometry3d> poses;
    std::vector<Twist> twists;
    std::vector<int> still;
  };

  /// Decides when bodies are placed, so often that none goes far in between, but not much more often than
  /// steps are taken.
  void schedule() {
    schedule_.clear();
    if (std::all_of(bodies_.begin(), bodies_.end(), [](const Body& body) { return body.motion.empty(); })) {
      // Bodies that were removed, or have no pose yet, are nowhere.
      if (!bodies_.empty()) schedule_.push_back(instantAt(end_, nullptr));
      return;
    }
    const double shortest = 0.5 * std::min(trial_, parameters_.solver.max_step);
    divide(time_, end_, shortest);
  }

  void divide(double from, double to, double shortest) {
    if (schedule_.size() >= kMostPlacements) return;
    const double middle = 0.5 * (from + to);
    if (to - from > shortest && middle > from && middle < to && bodiesMoveFar(from, to)) {
      divide(from, middle, shortest);
      divide(middle, to, shortest);
    } else {
      schedule_.push_back(instantAt(to, schedule_.empty() ? nullptr : &schedule_.back()));
    }
  }

  /// Whether some body moves so far that sand has to make way in between. Rays are dear, and a body crosses a
  /// column in many steps; whoever looks at the end of an advance finds that sand has made way for all
  /// bodies.
  bool bodiesMoveFar(double from, double to) const {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
      if (body.motion.empty()) return false;
      const Eigen::Isometry3d before = body.motion.poseAt(from);
      const Eigen::Isometry3d after = body.motion.poseAt(to);
      const double turned = turnBetween(before, after).angle();
      const double moved = (after.translation() - before.translation()).norm() + turned * body.reach;
      return moved > kLongestWayBetweenPlacements * grid_.spacing;
    });
  }

  /// @param before the placement before; null if that is the one for which sand made way the last time
  Instant instantAt(double time, const Instant* before) const {
    Instant now{time, {}, {}, {}};
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const Body& body = bodies_[k];
      const Eigen::Isometry3d pose =
          body.motion.empty() ? Eigen::Isometry3d::Identity() : body.motion.poseAt(time);
      const Eigen::Isometry3d& was = before ? before->poses[k] : body.placed_at;
      const double since = before ? before->time : body.placed_time;
      const int still = before ? before->still[k] : body.still;
      now.poses.push_back(pose);
      now.twists.push_back(cameWith(body, was, since, pose, time));
      now.still.push_back(std::isfinite(since) && pose.matrix() == was.matrix() ? still + 1 : 0);
    }
    return now;
  }

  /// With which a body came from where it was placed the last time.
  static Twist cameWith(const Body& body, const Eigen::Isometry3d& was, double since,
                        const Eigen::Isometry3d& pose, double time) {
    if (body.motion.empty()) return {};
    if (std::isinf(since)) return body.motion.twistAt(time);
    const double duration = time - since;
    if (!(duration > 0.0)) return {};
    return twistOf(pose.translation() - was.translation(), turnBetween(was, pose), duration);
  }

  std::vector<Placement> placementsOf(const std::vector<Instant>& instants) const {
    std::vector<Placement> placements;
    for (const Instant& instant : instants) placements.push_back({instant.time, placed(instant)});
    return placements;
  }

  /// Moves sand out of the bodies where they are now.
  void placeBodies() {
    if (bodies_.empty()) return;
    const Instant now = instantAt(time_, nullptr);
    engine_->placeBodies(placed(now), std::max(1, steps_since_placed_));
    steps_since_placed_ = 0;
    notePlaced(now);
  }

  /// Sand has made way for this placement.
  void notePlaced(const Instant& instant) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      Body& body = bodies_[k];
      if (body.motion.empty()) continue;
      body.placed_at = instant.poses[k];
      body.placed_time = instant.time;
      body.still = instant.still[k];
    }
  }

  double bodyOverlap() {
    finish();
    if (bodies_.empty()) return 0.0;
    return engine_->overlap(placed(instantAt(time_, nullptr)));
  }

  std::vector<SandContact> contacts(const Fields& now) {
    finish();
    if (now.depth.size() != grid_.cells()) {
      throw InvalidParameter("fields", std::to_string(now.depth.size()) + " cells",
                             std::to_string(grid_.cells()));
    }
    const Instant instant = instantAt(time_, nullptr);
    std::vector<PlacedBody> bodies;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (bodies_[k].motion.empty()) continue;
      bodies.push_back(place(k, instant.poses[k], instant.twists[k]));
      bodies.back().view.field.distance = bodies_[k].field->distance.data();
    }
    std::vector<SandContact> contacts = sandContacts(grid_, now, bodies, instructions());
    const std::vector<Eigen::Vector2d> given = engine_->givenMomentum();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      contacts[k].name = bodies_[bodies[k].body].name;
      contacts[k].given_momentum = given[bodies[k].body];
    }
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const SandContact& a, const SandContact& b) { return a.name < b.name; });
    return contacts;
  }

  void requireShorterStep(double bound) const {
    const SolverParameters& solver = parameters_.solver;
    std::ostringstream expected;
    expected << "at most " << bound << " s at " << time_ << " s, where waves and bodies move at "
             << solver.courant * grid_.spacing / bound << " m/s (courant · spacing / speed)";
    throw InvalidParameter("solver.fixed_step", std::to_string(*solver.fixed_step), expected.str());
  }

  std::vector<PlacedBody> placed(const Instant& instant) const {
    std::vector<PlacedBody> placed;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (bodies_[k].motion.empty()) continue;
      PlacedBody body = place(k, instant.poses[k], instant.twists[k]);
      body.still = instant.still[k];
      if (!body.window.empty()) placed.push_back(body);
    }
    return placed;
  }

  PlacedBody place(std::size_t number, Eigen::Isometry3d pose, const Twist& twist) const {
    const DistanceField& field = *bodies_[number].field;
    pose.pretranslate(-Eigen::Vector3d(grid_.origin_x, grid_.origin_y, 0.0));

    PlacedBody placed;
    placed.body = number;
    BodyView& view = placed.view;
    view.field = field.view(nullptr);
    const Eigen::Matrix3d to_body = pose.linear().transpose();
    view.axis_x = toVector3(to_body.col(0));
    view.axis_y = toVector3(to_body.col(1));
    view.axis_z = toVector3(to_body.col(2));
    view.position = toVector3(pose.translation());
    const bool level = parameters_.coupling == Coupling::horizontal_drag;
    const Eigen::Vector3d kept = level ? Eigen::Vector3d(1.0, 1.0, 0.0) : Eigen::Vector3d(1.0, 1.0, 1.0);
    const Eigen::Vector3d kept_turn = level ? Eigen::Vector3d(0.0, 0.0, 1.0) : Eigen::Vector3d(1.0, 1.0, 1.0);
    view.linear = toVector3(twist.linear.cwiseProduct(kept));
    view.angular = toVector3(twist.angular.cwiseProduct(kept_turn));
    Eigen::AlignedBox3d box;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d steps(corner & 1 ? field.samples[0] - 1 : 0,
                                  corner & 2 ? field.samples[1] - 1 : 0,
                                  corner & 4 ? field.samples[2] - 1 : 0);
      box.extend(pose * (field.origin + field.spacing * steps));
    }
    view.low = toVector3(box.min());
    view.high = toVector3(box.max());
    placed.window = Window::around(box.min().x(), box.min().y(), box.max().x(), box.max().y(), grid_);
    return placed;
  }

  Fields fields() {
    finish();
    return engine_->fields();
  }

  SandFigures figures() {
    finish();
    const SandConstants sand = sandConstants(grid_, parameters_.gravity, parameters_.material);
    const SandView view = engine_->view();
    SandFigures figures;
    double ground = 0.0;
    double loads = 0.0;
    const auto isMoving = [&](float depth, float momentum_x, float momentum_y) {
      if (momentum_x == 0.0f && momentum_y == 0.0f) return false;
      const double inverse = inverseDepth(depth, sand);
      figures.max_speed = std::max(figures.max_speed, inverse * std::hypot(momentum_x, momentum_y));
      return true;
    };
    for (std::size_t k = 0; k < grid_.cells(); ++k) {
      const bool swapped = view.cover != nullptr && view.cover[k] == Cover::touching;
      ground += swapped ? view.load[k] : view.depth[k];
      bool moves = isMoving(view.depth[k], view.momentum_x[k], view.momentum_y[k]);
      if (view.load != nullptr) {
        loads += swapped ? view.depth[k] : view.load[k];
        moves |= isMoving(view.load[k], view.load_momentum_x[k], view.load_momentum_y[k]);
      }
      figures.active_cells += moves ? 1 : 0;
    }
    figures.ledger = {start_volume_, poured_before_ + engine_->poured(), left_before_ + engine_->left(),
                      (ground + loads) * grid_.cellArea()};
    return figures;
  }

  static constexpr double kLongestWayBetweenPlacements = 0.25;  // of a body [cells]
  static constexpr std::size_t kMostPlacements = 64;            // in a run of steps

  SimulatorParameters parameters_;
  MaterialFields material_fields_;  // maps that were given at the start
  Grid grid_;
  ChosenBackend chosen_;
  std::unique_ptr<Engine> engine_;
  std::vector<Body> bodies_;
  double start_volume_ = 0.0;
  double poured_before_ = 0.0;  // before the snapshot from which this goes on [m³]
  double left_before_ = 0.0;
  double time_ = 0.0;
  double trial_ =
      std::numeric_limits<double>::infinity();  // length of the next step unless something forbids it [s]
  Progress progress_;
  double grains_moved_until_ = 0.0;  // [s]
  std::uint32_t grain_moves_ = 0;
  int steps_since_placed_ = 0;
  double end_ = 0.0;               // to which the sand is to be advanced [s]
  bool runs_ = false;              // the engine takes steps
  std::vector<Instant> schedule_;  // when and where bodies are placed in this run
  bool placed_anew_ = false;       // a body has its first pose, and sand may be where it is
};

Simulator::Simulator(const SimulatorParameters& parameters, std::vector<float> bed, std::vector<float> depth,
                     const MaterialFields& material)
    : implementation_(
          std::make_unique<Implementation>(parameters, std::move(bed), std::move(depth), material)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const SimulatorParameters& Simulator::parameters() const { return implementation_->parameters_; }
const Grid& Simulator::grid() const { return implementation_->grid_; }
Backend Simulator::backend() const { return implementation_->chosen_.backend; }
int Simulator::threads() const { return implementation_->chosen_.threads; }
const std::string& Simulator::backendNotice() const { return implementation_->chosen_.notice; }

std::size_t Simulator::addBody(const std::string& name, std::shared_ptr<const DistanceField> field) {
  implementation_->addBody(name, std::move(field));
  return implementation_->bodies_.size() - 1;
}
void Simulator::appendPose(std::size_t body, double time, const Eigen::Isometry3d& pose) {
  implementation_->appendPose(body, time, pose);
}
void Simulator::placeBody(std::size_t body, const Eigen::Isometry3d& pose) {
  implementation_->placeBody(body, pose);
}
void Simulator::removeBody(std::size_t body) { implementation_->removeBody(body); }
void Simulator::addPour(const Pour& pour) { implementation_->addPour(pour); }
double Simulator::edit(const Edit& edit) { return implementation_->edit(edit); }
double Simulator::setSand(EditOperation operation, const CellValues& cells) {
  return implementation_->setSand(operation, cells);
}
void Simulator::setMaterial(const Material& material) { implementation_->setMaterial(material); }
void Simulator::setGravity(const Eigen::Vector3d& gravity) { implementation_->setGravity(gravity); }
Snapshot Simulator::snapshot() const { return implementation_->snapshot(); }
void Simulator::restore(const Snapshot& snapshot) { implementation_->restore(snapshot); }
void Simulator::advance(double duration) {
  if (!(duration >= 0.0) || !std::isfinite(duration)) {
    throw InvalidParameter("duration", std::to_string(duration), "seconds, finite and not negative");
  }
  advanceTo(time() + duration);
}
void Simulator::advanceTo(double time) {
  beginAdvanceTo(time);
  implementation_->finish();
}
void Simulator::beginAdvanceTo(double time) { implementation_->beginAdvanceTo(time); }
double Simulator::time() const {
  implementation_->finish();
  return implementation_->time_;
}

void Simulator::requestFields() {
  implementation_->finish();
  implementation_->engine_->requestFields();
}
const Fields& Simulator::collectFields() { return implementation_->engine_->collectFields(); }
std::vector<Window> Simulator::takeChanges() { return implementation_->engine_->takeChanges(); }
Fields Simulator::fields() const { return implementation_->fields(); }
Grains Simulator::grains() const { return implementation_->grains(); }
SandFigures Simulator::figures() const { return implementation_->figures(); }
Ledger Simulator::ledger() const { return figures().ledger; }
double Simulator::maxSpeed() const { return figures().max_speed; }
std::size_t Simulator::activeCells() const { return figures().active_cells; }
const Progress& Simulator::progress() const {
  implementation_->finish();
  return implementation_->progress_;
}
double Simulator::bodyOverlap() const { return implementation_->bodyOverlap(); }
std::vector<SandContact> Simulator::contacts(const Fields& now) const {
  return implementation_->contacts(now);
}

}  // namespace shallow_sand
