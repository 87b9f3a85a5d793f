#include <algorithm>
#include <numeric>
#include <utility>

#include "shallow_sand/sim/cuda_engine.cuh"

namespace shallow_sand {

namespace {

const dim3 kBlock(kBlockColumns, kBlockRows);

template <bool with_bodies, bool with_slopes>
__global__ void __launch_bounds__(kBlockThreads, 1)
    takeStepsOnGpu(SHALLOW_SAND_GRID_CONSTANT const GpuRun run,
                   SHALLOW_SAND_GRID_CONSTANT const StepRun start, StepRun* result) {
  __shared__ RunInBlock here;
  SandOnGpu<with_bodies, with_slopes> sand(run, start, here);
  takeSteps(sand, here.run);
  sand.finish(result);
}

using TakeSteps = void (*)(GpuRun, StepRun, StepRun*);

TakeSteps kernelFor(bool with_bodies, bool with_slopes) {
  if (with_bodies) return with_slopes ? takeStepsOnGpu<true, true> : takeStepsOnGpu<true, false>;
  return with_slopes ? takeStepsOnGpu<false, true> : takeStepsOnGpu<false, false>;
}

__global__ void __launch_bounds__(kBlockThreads, 1) changeSandOnGpu(const ChangeSand change) {
  const int i = change.window.column_begin + static_cast<int>(blockIdx.x * kBlockColumns + threadIdx.x);
  const int j = change.window.row_begin + static_cast<int>(blockIdx.y * kBlockRows + threadIdx.y);
  if (change.window.holds(i, j)) change(i, j);
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    touchCells(const DueTiles tiles, const Window cells, const StepNumber step) {
  const int i = cells.column_begin + static_cast<int>(blockIdx.x * kBlockColumns + threadIdx.x);
  const int j = cells.row_begin + static_cast<int>(blockIdx.y * kBlockRows + threadIdx.y);
  if (cells.holds(i, j)) tiles.touch(i, j, step);
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    measureOverlap(const BodiesOnGpu bodies, const StepArguments step, float* overlap) {
  const CellBlock& block = bodies.blocks[blockIdx.x];
  const int i = block.cells.column_begin + static_cast<int>(threadIdx.x);
  const int j = block.cells.row_begin + static_cast<int>(threadIdx.y);
  if (!block.cells.holds(i, j)) return;
  const MeasureOverlap measure{bodies.overBed(block.window, 0, nullptr, step), bodies.columns,
                               bodies.contact.top, overlap};
  measure(i, j, solidsAt(measure, i, j));
}

dim3 blocksFor(const Window& window) {
  return dim3(static_cast<unsigned>(DueTiles::tilesAcross(window.columns())),
              static_cast<unsigned>(DueTiles::tilesUp(window.rows())));
}

/// How many blocks of a kernel the current GPU runs at once: a cooperative launch may have no more.
int mostBlocks(TakeSteps kernel) {
  int device = 0;
  int multiprocessors = 0;
  int blocks = 0;
  checkCuda(cudaGetDevice(&device), "tell which GPU is in use");
  checkCuda(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
            "count multiprocessors");
  checkCuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, kBlockThreads, 0),
            "count the blocks that fit the GPU");
  return multiprocessors * blocks;
}

}  // namespace

CudaEngine::TileMemory::TileMemory(const Grid& grid)
    : count(DueTiles::tilesAcross(grid.columns) * DueTiles::tilesUp(grid.rows)),
      listed(static_cast<std::size_t>(DueTiles::kLists) * static_cast<std::size_t>(count), DueTiles::kNever),
      lists(static_cast<std::size_t>(DueTiles::kLists) * static_cast<std::size_t>(count)),
      lengths(DueTiles::kLists),
      cells(DueTiles::kLists),
      crowded(DueTiles::kLists),
      speeds(static_cast<std::size_t>(count)),
      is_near(static_cast<std::size_t>(count)),
      changed(static_cast<std::size_t>(count)) {}

DueTiles CudaEngine::TileMemory::tiles(const Grid& grid) {
  return {grid.columns,   grid.rows,      DueTiles::tilesAcross(grid.columns),
          count,          listed.data(),  lists.data(),
          lengths.data(), cells.data(),   crowded.data(),
          speeds.data(),  is_near.data(), changed.data()};
}

CudaEngine::CudaEngine(const EngineStart& start, std::uint64_t steps_at_once)
    : grid_(start.grid),
      steps_at_once_(steps_at_once),
      with_slopes_(start.with_slopes),
      displacement_(start.displacement),
      memory_(start),
      grains_(grainMemoryOf<CudaMemory>(start)),
      tile_memory_(start.grid),
      rests_(std::vector<int>{0, 1}),
      courier_(start.grid, start.fields) {
  touch(Window::all(grid_));
}

CudaEngine::~CudaEngine() {
  cudaStreamSynchronize(stream_);  // a run that nobody waited for still uses the memory
}

void CudaEngine::addBody(const DistanceField& field) {
  std::vector<unsigned char> apart = memory_.downloaded(apart_);
  apart.push_back(0);
  CudaMemory<unsigned char> apart_on_gpu(apart);
  courier_.expectLoads();
  memory_.addBody(field);
  apart_ = std::move(apart_on_gpu);
}

void CudaEngine::removeBody(std::size_t body) {
  memory_.removeBody(body);
  last_placed_.erase(std::remove_if(last_placed_.begin(), last_placed_.end(),
                                    [&](const PlacedBody& placed) { return placed.body == body; }),
                     last_placed_.end());
}

void CudaEngine::addPour(const LocalRegion& region, const PourTimes& times) {
  memory_.addPour(region, times);
}

void CudaEngine::expectSand(const LocalRegion& region) { expected_.push_back(windowOf(region, grid_)); }

/// Makes the GPU know the bodies of a run, and where they were before it.
void CudaEngine::sendBodies(const std::vector<PlacedBody>& before, std::vector<Placement> placements) {
  placements.insert(placements.begin(), {0.0, before});
  std::vector<Window> poured_on = expected_;
  for (const auto& pour : memory_.pours) poured_on.push_back(pour.change.window);
  tables_ = makeRunTables(placements, memory_.distance_fields.size(), held_, poured_on, grid_);
  for (std::size_t k = 0; k < tables_.views.size(); ++k)
    tables_.views[k].field.distance = memory_.distance_fields[k % memory_.distance_fields.size()].data();
  placed_at_.send(tables_.placed_at, stream_);
  views_.send(tables_.views, stream_);
  reaches_.send(tables_.reaches, stream_);
  windows_.send(tables_.windows, stream_);
  blocks_.send(tables_.blocks, stream_);
  wide_windows_.send(tables_.wide_windows, stream_);
  wide_blocks_.send(tables_.wide_blocks, stream_);
  bin_first_.send(tables_.bin_first, stream_);
  bin_members_.send(tables_.bin_members, stream_);
  given_sums_.send(memory_.givenSums(), stream_);
  makeRoomForGiven();
}

void CudaEngine::makeRoomForGiven() {
  if (tables_.windows.empty()) return;
  const std::size_t cells = tables_.windows.back().first_cell + tables_.windows.back().cells.cells();
  if (cells <= given_.size()) return;
  const std::size_t room = std::min(2 * cells, grid_.cells());
  CudaMemory<std::uint8_t> some_given(room);
  given_ = CudaMemory<GivenMomentum>(room);
  some_given_ = std::move(some_given);
}

BodiesOnGpu CudaEngine::bodiesOnGpu() {
  if (memory_.contacts.empty()) return {};
  auto& contacts = memory_.contacts.front();
  return {static_cast<int>(memory_.distance_fields.size()),
          views_.data(),
          reaches_.data(),
          apart_.data(),
          displacement_,
          windows_.data(),
          static_cast<int>(tables_.windows.size()),
          blocks_.data(),
          static_cast<int>(tables_.blocks.size()),
          wide_windows_.data(),
          wide_blocks_.data(),
          static_cast<int>(tables_.wide_blocks.size()),
          bin_first_.data(),
          bin_members_.data(),
          memory_.bed.data(),
          memory_.contact(),
          memory_.columns(),
          contacts.next_hidden.layer(),
          contacts.pushed.layer(),
          given_.data(),
          some_given_.data(),
          given_sums_.data(),
          contacts.distance.data(),
          contacts.flowed.data(),
          rests_.data()};
}

GpuRun CudaEngine::runOnGpu() {
  std::vector<PourOnGpu> pours;
  for (auto& pour : memory_.pours) {
    memory_.bind(pour.change, pour.taken);
    pours.push_back({pour.change, static_cast<double>(pour.covered) * grid_.cellArea(), pour.times});
  }
  pours_.send(pours, stream_);
  return {memory_.stepOf(!memory_.contacts.empty()),
          memory_.state.layer(),
          memory_.next.layer(),
          tile_memory_.tiles(grid_),
          next_step_,
          memory_.left_over_edges.data(),
          pours_.data(),
          static_cast<int>(pours.size()),
          bodiesOnGpu(),
          ballots_.data()};
}

void CudaEngine::launch(const StepRun& run) {
  run_ = run;
  run_.most_steps = run.progress.steps + steps_at_once_;
  GpuRun run_on_gpu = runOnGpu();
  const TakeSteps kernel = kernelFor(!tables_.windows.empty(), with_slopes_);
  const int useful = std::max(tile_memory_.count, static_cast<int>(tables_.wide_blocks.size()));
  const int blocks = std::min(useful, mostBlocks(kernel));
  checkCuda(cudaMemsetAsync(ballots_.data(), 0, sizeof(Ballots), stream_), "clear memory");
  StepRun* result = result_.data();
  void* arguments[] = {&run_on_gpu, &run_, &result};
  checkCuda(cudaLaunchCooperativeKernel(reinterpret_cast<const void*>(kernel),
                                        dim3(static_cast<unsigned>(blocks)), kBlock, arguments, 0, stream_),
            "start a run of steps");
  checkCuda(cudaMemcpyAsync(arrived_.data(), result, sizeof(StepRun), cudaMemcpyDeviceToHost, stream_),
            "copy from the GPU");
}

void CudaEngine::placeBodies(const std::vector<PlacedBody>& bodies, int steps) {
  sendBodies({}, {{0.0, bodies}});
  StepRun no_steps{};
  no_steps.placed_at = placed_at_.data() + 1;
  no_steps.placements = 1;
  no_steps.placement = -1;
  no_steps.steps_since_placed = steps;
  no_steps.displacement = displacement_;
  no_steps.moved = true;
  launch(no_steps);
  stream_.wait("make way for bodies");
  arePlaced(bodies);
  expected_.clear();
}

void CudaEngine::arePlaced(const std::vector<PlacedBody>& bodies) {
  last_placed_ = bodies;
  held_.clear();
  for (const PlacedBody& body : bodies) held_.push_back(body.window.grown(1, grid_));
  held_ = withoutOverlap(held_);
}

void CudaEngine::start(const StepRun& run, std::vector<Placement> placements) {
  placements_ = std::move(placements);
  StepRun wanted = run;
  if (!memory_.contacts.empty()) {
    sendBodies(last_placed_, placements_);
    wanted.placements = static_cast<int>(placements_.size());
    // That of the placement before the run comes first.
    wanted.placed_at = placed_at_.data() + 1;
  }
  launch(wanted);
}

StepRun CudaEngine::finish() {
  for (;;) {
    stream_.wait("take steps");
    const StepRun now = arrived_[0];
    const std::uint64_t steps = now.progress.steps - run_.progress.steps;
    next_step_ += steps;
    if (steps % 2 == 1) std::swap(memory_.state, memory_.next);
    if (now.placement > run_.placement)
      arePlaced(placements_[static_cast<std::size_t>(now.placement)].bodies);
    StepRun onwards = now;
    onwards.placed_at = now.placements > 0 ? tables_.placed_at.data() + 1 : nullptr;
    onwards.most_steps = std::numeric_limits<std::uint64_t>::max();
    if (!onwards.goesOn()) {
      onwards.placed_at = nullptr;
      return onwards;
    }
    launch(now);
  }
}

void CudaEngine::setSand(const SandConstants& sand, const LocalMaterialFields& material) {
  memory_.setSand(sand, material);
  touch(Window::all(grid_));
}

double CudaEngine::edit(const LocalRegion& region, EditOperation operation, float value) {
  ChangeSand change = memory_.changeOf(region);
  change.operation = operation;
  change.value = value;
  return apply(change);
}

double CudaEngine::edit(EditOperation operation, const std::vector<float>& values) {
  const CudaMemory<float> uploaded(values);
  ChangeSand change = memory_.changeOf(wholeMap());
  change.operation = operation;
  change.values = uploaded.data();
  return apply(change);
}

double CudaEngine::apply(ChangeSand& change) {
  if (change.window.empty()) return 0.0;
  CudaMemory<double> taken(change.window.cells(), 0.0);
  memory_.bind(change, taken);
  changeSandOnGpu<<<blocksFor(change.window), kBlock, 0, stream_>>>(change);
  checkCuda(cudaGetLastError(), "edit the sand");
  touch(change.window);
  return memory_.book(taken);
}

void CudaEngine::touch(const Window& cells) {
  touchCells<<<blocksFor(cells), kBlock, 0, stream_>>>(tile_memory_.tiles(grid_), cells, next_step_);
  checkCuda(cudaGetLastError(), "wake the sand");
}

Fields CudaEngine::fields() {
  requestFields();
  return collectFields();
}

SandView CudaEngine::view() {
  requestFields();
  const Fields& f = collectFields();
  if (f.load.empty())
    return {f.depth.data(), f.momentum_x.data(), f.momentum_y.data(), nullptr, nullptr, nullptr, nullptr};
  return {f.depth.data(), f.momentum_x.data(),      f.momentum_y.data(),
          f.load.data(),  f.load_momentum_x.data(), f.load_momentum_y.data(),
          nullptr};
}

void CudaEngine::requestFields() {
  FieldSources sources{memory_.state.layer(), {}, nullptr};
  if (!memory_.contacts.empty()) sources = {{}, memory_.columns(), memory_.contacts.front().top.data()};
  courier_.request(tile_memory_.tiles(grid_), sources, stream_);
}

const Fields& CudaEngine::collectFields() { return courier_.collect(); }

double CudaEngine::overlap(const std::vector<PlacedBody>& bodies) {
  if (memory_.contacts.empty()) return 0.0;
  if (overlap_.size() == 0) overlap_ = CudaMemory<float>(grid_.cells());
  sendBodies(bodies, {});
  checkCuda(cudaMemsetAsync(overlap_.data(), 0, grid_.cells() * sizeof(float), stream_), "clear memory");
  if (!tables_.blocks.empty()) {
    measureOverlap<<<static_cast<unsigned>(tables_.blocks.size()), kBlock, 0, stream_>>>(
        bodiesOnGpu(), memory_.stepOf(false), overlap_.data());
    checkCuda(cudaGetLastError(), "measure the sand in bodies");
  }
  const std::vector<float> depths = memory_.downloaded(overlap_);
  return std::accumulate(depths.begin(), depths.end(), 0.0) * grid_.cellArea();
}

void CudaEngine::restore(const Fields& fields, const ContactSnapshot& contacts) {
  memory_.restore(fields, contacts);
  courier_.reset(fields);
  touch(Window::all(grid_));
  held_ = contacts.windows;
  last_placed_.clear();
  rests_ = CudaMemory<int>(std::vector<int>{0, 1});
  apart_ = CudaMemory<unsigned char>(memory_.distance_fields.size());
}

void CudaEngine::moveGrains(float duration, std::uint32_t number) {
  const AwakeCells awake{tile_memory_.tiles(grid_), next_step_, blocks_.data(),
                         static_cast<int>(tables_.blocks.size())};
  ::shallow_sand::moveGrains(grains_->move(memory_.visibleSand(), duration, number), awake, stream_);
}

std::unique_ptr<Engine> makeCudaEngine(const EngineStart& start, std::uint64_t steps_at_once) {
  return std::make_unique<CudaEngine>(start, steps_at_once);
}

std::uint64_t cudaStepsAtOnce(const Grid& grid) {
  constexpr std::uint64_t kCells = 1000000000;
  constexpr std::uint64_t kMost = 20000;
  return std::min(kMost, std::max<std::uint64_t>(16, kCells / grid.cells()));
}

std::string cudaUnavailable() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  if (devices == 0) return "no CUDA-capable device is detected";
  int device = 0;
  int cooperative = 0;
  cudaGetDevice(&device);
  cudaDeviceGetAttribute(&cooperative, cudaDevAttrCooperativeLaunch, device);
  if (cooperative == 0) return "the GPU has no cooperative launches";
  // A GPU older than those that the kernels were compiled for is found out here, not at the first launch.
  cudaFuncAttributes attributes{};
  const cudaError_t kernel = cudaFuncGetAttributes(&attributes, takeStepsOnGpu<false, false>);
  return kernel == cudaSuccess ? "" : cudaGetErrorString(kernel);
}

std::string cudaDeviceName() {
  int device = 0;
  cudaDeviceProp properties{};
  checkCuda(cudaGetDevice(&device), "tell which GPU is in use");
  checkCuda(cudaGetDeviceProperties(&properties, device), "read the GPU's name");
  return properties.name;
}

}  // namespace shallow_sand
