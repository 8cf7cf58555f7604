// Particle filters with an adaptive number of particles (KLD) by the Point Cloud Library, one for each thing, with the
// settings of the library's own example.
// Reads messages from standard input. "B": float32 x y z of the middle of a new thing, int32 n, n float32 x y z relative
// to it. "F": int32 n, n float32 x y z of a frame; the answer is int32 k, float32 x y z of the middles of the k things
// in the order in which they began, and float64 seconds of processor time. Lengths are metres.
#include <pcl/filters/approximate_voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/octree.h>
#include <pcl/tracking/approx_nearest_pair_point_cloud_coherence.h>
#include <pcl/tracking/distance_coherence.h>
#include <pcl/tracking/impl/approx_nearest_pair_point_cloud_coherence.hpp>
#include <pcl/tracking/impl/distance_coherence.hpp>
#include <pcl/tracking/impl/kld_adaptive_particle_filter.hpp>
#include <pcl/tracking/impl/kld_adaptive_particle_filter_omp.hpp>
#include <pcl/tracking/impl/particle_filter.hpp>
#include <pcl/tracking/impl/tracking.hpp>
#include <pcl/tracking/kld_adaptive_particle_filter_omp.h>
#include <pcl/tracking/tracking.h>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
using Particle = pcl::tracking::ParticleXYZRPY;
// Without OpenMP, the class of the library never moves its particles.
using Tracker = pcl::tracking::KLDAdaptiveParticleFilterOMPTracker<Point, Particle>;

constexpr float kGrid = 0.005f;     // side of the voxels of things and frames
constexpr double kReach = 0.01;     // largest distance of points that count as near

bool read(void *into, std::size_t bytes) { return std::fread(into, 1, bytes, stdin) == bytes; }

Cloud::Ptr readCloud() {
  std::int32_t n = 0;
  Cloud::Ptr dense(new Cloud), thin(new Cloud);
  if (!read(&n, sizeof n)) return thin;
  std::vector<float> places(3 * n);
  read(places.data(), places.size() * sizeof(float));
  for (std::int32_t i = 0; i < n; ++i) dense->push_back(Point(places[3 * i], places[3 * i + 1], places[3 * i + 2]));
  pcl::ApproximateVoxelGrid<Point> grid;
  grid.setLeafSize(kGrid, kGrid, kGrid);
  grid.setInputCloud(dense);
  grid.filter(*thin);
  return thin;
}

std::unique_ptr<Tracker> begun(const float *middle, const Cloud::Ptr &thing) {
  auto tracker = std::make_unique<Tracker>(1);
  std::vector<double> step(6, 0.015 * 0.015), first(6, 0.00001), mean(6, 0.0);
  for (int k = 3; k < 6; ++k) step[k] *= 40.0;
  Particle bin;
  bin.x = bin.y = bin.z = bin.roll = bin.pitch = bin.yaw = 0.1f;
  tracker->setMaximumParticleNum(1000);
  tracker->setDelta(0.99);
  tracker->setEpsilon(0.2);
  tracker->setBinSize(bin);
  tracker->setStepNoiseCovariance(step);
  tracker->setInitialNoiseCovariance(first);
  tracker->setInitialNoiseMean(mean);
  tracker->setIterationNum(1);
  tracker->setParticleNum(600);
  tracker->setResampleLikelihoodThr(0.0);
  tracker->setUseNormal(false);
  using Coherence = pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>;
  Coherence::Ptr coherence(new Coherence);
  coherence->addPointCoherence(pcl::tracking::DistanceCoherence<Point>::Ptr(new pcl::tracking::DistanceCoherence<Point>));
  coherence->setSearchMethod(pcl::search::Octree<Point>::Ptr(new pcl::search::Octree<Point>(0.01)));
  coherence->setMaximumDistance(kReach);
  tracker->setCloudCoherence(coherence);
  tracker->setReferenceCloud(thing);
  tracker->setTrans(Eigen::Affine3f(Eigen::Translation3f(middle[0], middle[1], middle[2])));
  tracker->setMinIndices(static_cast<int>(thing->size()) / 2);
  return tracker;
}

int main() {
  std::vector<std::unique_ptr<Tracker>> trackers;
  for (char what = 0; read(&what, 1);) {
    if (what == 'B') {
      float middle[3];
      read(middle, sizeof middle);
      trackers.push_back(begun(middle, readCloud()));
      continue;
    }
    const Cloud::Ptr frame = readCloud();
    const std::clock_t started = std::clock();
    const std::int32_t count = static_cast<std::int32_t>(trackers.size());
    std::fwrite(&count, sizeof count, 1, stdout);
    for (auto &tracker : trackers) {
      tracker->setInputCloud(frame);
      tracker->compute();
      const Eigen::Vector3f place = tracker->toEigenMatrix(tracker->getResult()).translation();
      std::fwrite(place.data(), sizeof(float), 3, stdout);
    }
    const double seconds = static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    std::fwrite(&seconds, sizeof seconds, 1, stdout);
    std::fflush(stdout);
  }
  return 0;
}
