#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "shallow_sand/device/cuda_memory.cuh"
#include "shallow_sand/sim/field_courier.cuh"
#include "shallow_sand/sim/grains_on_gpu.cuh"
#include "shallow_sand/sim/run_tables.h"
#include "shallow_sand/sim/sand_memory.h"
#include "shallow_sand/sim/sand_on_gpu.cuh"

namespace shallow_sand {

/// The engine on a GPU. A run of steps is one cooperative launch that decides by itself how long steps are
/// and when sand makes way for bodies: the host hears nothing of it before its end.
class CudaEngine : public Engine {
 public:
  CudaEngine(const EngineStart& start, std::uint64_t steps_at_once);
  ~CudaEngine() override;

  void addBody(const DistanceField& field) override;
  void removeBody(std::size_t body) override;
  void addPour(const LocalRegion& region, const PourTimes& times) override;
  void placeBodies(const std::vector<PlacedBody>& bodies, int steps) override;
  void expectSand(const LocalRegion& region) override;
  void start(const StepRun& run, std::vector<Placement> placements) override;
  StepRun finish() override;
  void setSand(const SandConstants& sand, const LocalMaterialFields& material) override;
  double edit(const LocalRegion& region, EditOperation operation, float value) override;
  double edit(EditOperation operation, const std::vector<float>& values) override;
  Fields fields() override;
  SandView view() override;
  void requestFields() override;
  const Fields& collectFields() override;
  std::vector<Window> takeChanges() override { return courier_.takeChanges(); }
  double poured() const override { return memory_.poured(); }
  double left() const override { return memory_.left(); }
  double overlap(const std::vector<PlacedBody>& bodies) override;
  void moveGrains(float duration, std::uint32_t number) override;
  std::vector<Grain> grains() override { return grains_->get(); }
  void setGrains(const std::vector<Grain>& grains) override { grains_->set(grains); }
  std::vector<Eigen::Vector2d> givenMomentum() const override { return memory_.givenMomentum(); }
  ContactSnapshot contacts() const override { return memory_.snapshot(held_); }
  void restore(const Fields& fields, const ContactSnapshot& contacts) override;

 private:
  /// Memory of DueTiles.
  struct TileMemory {
    explicit TileMemory(const Grid& grid);
    DueTiles tiles(const Grid& grid);
    int count;
    CudaMemory<StepNumber> listed;
    CudaMemory<int> lists;
    CudaMemory<int> lengths;
    CudaMemory<int> cells;
    CudaMemory<int> crowded;
    CudaMemory<float> speeds;
    CudaMemory<unsigned char> is_near;
    CudaMemory<unsigned char> changed;
  };

  double apply(ChangeSand& change);
  void sendBodies(const std::vector<PlacedBody>& before, std::vector<Placement> placements);
  void makeRoomForGiven();
  void arePlaced(const std::vector<PlacedBody>& bodies);
  BodiesOnGpu bodiesOnGpu();
  GpuRun runOnGpu();
  void launch(const StepRun& run);
  void touch(const Window& cells);

  Grid grid_;
  std::uint64_t steps_at_once_;
  bool with_slopes_;
  bool displacement_;
  CudaStream stream_;
  SandMemory<CudaMemory> memory_;
  std::optional<GrainMemory<CudaMemory>> grains_;
  TileMemory tile_memory_;
  CudaMemory<Ballots> ballots_{1};
  CudaMemory<int> rests_;
  CudaMemory<StepRun> result_{1};
  PinnedMemory<StepRun> arrived_{1};  // what has come from result_
  FieldCourier courier_;
  StepNumber next_step_ = 0;

  RunTables tables_;  // of the run that was started last
  SentList<double> placed_at_;
  SentList<BodyView> views_;
  SentList<BodyReach> reaches_;
  SentList<CrowdedWindow> windows_;
  SentList<CellBlock> blocks_;
  SentList<Window> wide_windows_;
  SentList<CellBlock> wide_blocks_;
  SentList<int> bin_first_;
  SentList<int> bin_members_;
  SentList<PourOnGpu> pours_;
  SentList<double*> given_sums_;
  CudaMemory<GivenMomentum> given_{0};
  CudaMemory<std::uint8_t> some_given_{0};
  CudaMemory<unsigned char> apart_{0};
  CudaMemory<float> overlap_{0};
  StepRun run_{};                        // as it was started
  std::vector<Placement> placements_;    // of that run
  std::vector<PlacedBody> last_placed_;  // before it
  std::vector<Window> held_;             // columns that bodies may touch, when they were placed the last time
  std::vector<Window> expected_;         // where sand will come down before bodies are placed again
};

}  // namespace shallow_sand
