// Particle filter trackers of the Point Cloud Library, one for each thing, as a peer of bench_tracking.py.
//
// Reads messages from standard input and writes poses to standard output, in the byte order of the machine:
//   'M', uint32 n, then n points (3 float32 coordinates, 3 uint8 colours): the model of a further thing
//   'F', uint32 n, then n points: a frame; the answer is a 4 by 4 float32 matrix, row by row, for each thing: the
//        change of the pose of its model since the model was given; then the processor time that it took, a float32
// The settings are those of PCL's documented tracker: KLD-adaptive particles (600, at most 1000), distances and colours
// (HSV) of nearest points, models thinned to one point in 5 mm.

#include <cstdint>
#include <ctime>
#include <iostream>
#include <memory>
#include <vector>

#include <pcl/common/centroid.h>
#include <pcl/common/transforms.h>
#include <pcl/filters/approximate_voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/octree.h>
#include <pcl/tracking/approx_nearest_pair_point_cloud_coherence.h>
#include <pcl/tracking/coherence.h>
#include <pcl/tracking/distance_coherence.h>
#include <pcl/tracking/hsv_color_coherence.h>
#include <pcl/tracking/kld_adaptive_particle_filter.h>
#include <pcl/tracking/particle_filter.h>
#include <pcl/tracking/tracking.h>

using Point = pcl::PointXYZRGBA;
using Cloud = pcl::PointCloud<Point>;
using State = pcl::tracking::ParticleXYZRPY;
using Tracker = pcl::tracking::KLDAdaptiveParticleFilterTracker<Point, State>;

constexpr float kLeaf = 0.005f;  // metres

template <typename T>
bool read(T& value) {
  return static_cast<bool>(std::cin.read(reinterpret_cast<char*>(&value), sizeof(T)));
}

Cloud::Ptr read_cloud() {
  std::uint32_t count = 0;
  read(count);
  Cloud::Ptr cloud(new Cloud);
  for (std::uint32_t i = 0; i < count; ++i) {
    float place[3];
    std::uint8_t colour[3];
    read(place);
    read(colour);
    Point point;
    point.x = place[0], point.y = place[1], point.z = place[2];
    point.r = colour[0], point.g = colour[1], point.b = colour[2], point.a = 255;
    cloud->push_back(point);
  }
  return cloud;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud) {
  Cloud::Ptr few(new Cloud);
  pcl::ApproximateVoxelGrid<Point> grid;
  grid.setLeafSize(kLeaf, kLeaf, kLeaf);
  grid.setInputCloud(cloud);
  grid.filter(*few);
  return few;
}

struct Thing {
  std::shared_ptr<Tracker> tracker;
  Eigen::Affine3f start;
};

Thing thing_of(const Cloud::Ptr& model) {
  Thing thing;
  Eigen::Vector4f middle;
  pcl::compute3DCentroid(*model, middle);
  thing.start = Eigen::Affine3f::Identity();
  thing.start.translation() = middle.head<3>();
  Cloud::Ptr centred(new Cloud);
  pcl::transformPointCloud(*model, *centred, thing.start.inverse());

  std::vector<double> step(6, 0.015 * 0.015), initial(6, 0.00001), mean(6, 0.0);
  for (int i = 3; i < 6; ++i) step[i] *= 40.0;
  State bin;
  bin.x = bin.y = bin.z = bin.roll = bin.pitch = bin.yaw = 0.1f;
  thing.tracker = std::make_shared<Tracker>();
  Tracker& tracker = *thing.tracker;
  tracker.setMaximumParticleNum(1000);
  tracker.setDelta(0.99);
  tracker.setEpsilon(0.2);
  tracker.setBinSize(bin);
  tracker.setTrans(thing.start);
  tracker.setStepNoiseCovariance(step);
  tracker.setInitialNoiseCovariance(initial);
  tracker.setInitialNoiseMean(mean);
  tracker.setIterationNum(1);
  tracker.setParticleNum(600);
  tracker.setResampleLikelihoodThr(0.0);
  tracker.setUseNormal(false);

  pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>::Ptr coherence(
      new pcl::tracking::ApproxNearestPairPointCloudCoherence<Point>);
  pcl::tracking::DistanceCoherence<Point>::Ptr distance(new pcl::tracking::DistanceCoherence<Point>);
  coherence->addPointCoherence(distance);
  pcl::tracking::HSVColorCoherence<Point>::Ptr colour(new pcl::tracking::HSVColorCoherence<Point>);
  coherence->addPointCoherence(colour);
  pcl::search::Octree<Point>::Ptr search(new pcl::search::Octree<Point>(0.01));
  coherence->setSearchMethod(search);
  coherence->setMaximumDistance(0.01);
  tracker.setCloudCoherence(coherence);
  tracker.setReferenceCloud(thinned(centred));
  return thing;
}

int main() {
  std::ios::sync_with_stdio(false);
  std::vector<Thing> things;
  char kind;
  while (std::cin.get(kind)) {
    if (kind == 'M') {
      things.push_back(thing_of(read_cloud()));
      continue;
    }
    Cloud::Ptr whole = read_cloud();
    const std::clock_t started = std::clock();
    Cloud::Ptr frame = thinned(whole);
    std::vector<Eigen::Matrix4f> changes;
    for (Thing& thing : things) {
      if (!frame->empty()) {
        thing.tracker->setInputCloud(frame);
        thing.tracker->compute();
      }
      changes.push_back((thing.tracker->toEigenMatrix(thing.tracker->getResult()) * thing.start.inverse()).matrix());
    }
    const float seconds = static_cast<float>(std::clock() - started) / CLOCKS_PER_SEC;
    for (const Eigen::Matrix4f& change : changes)
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
          std::cout.write(reinterpret_cast<const char*>(&change(row, column)), sizeof(float));
    std::cout.write(reinterpret_cast<const char*>(&seconds), sizeof(float));
    std::cout.flush();
  }
  return 0;
}
