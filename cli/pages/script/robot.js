// SPDX-License-Identifier: BSD-3-Clause
// The robot's links as a tree of frames that joints move; parts of the scene hang in the frames.
const world = new THREE.Scene();
const link_frames = [];

function pose_to(object, pose) {
  object.position.fromArray(pose);
  object.quaternion.fromArray(pose, 3);
}

// A joint is its origin, fixed in the parent, and in that the moving frame of its child.
const joint_frames = [];
for (const link of robot_data ? robot_data.links : []) {
  const frame = new THREE.Group();
  if (link.joint < 0) {
    if (robot_data.pose) pose_to(frame, robot_data.pose);
    world.add(frame);
  } else {
    const joint = robot_data.joints[link.joint];
    const origin = new THREE.Group();
    pose_to(origin, joint.origin);
    link_frames[joint.parent].add(origin.add(frame));
    joint_frames.push({joint, frame, axis: new THREE.Vector3().fromArray(joint.axis)});
  }
  link_frames.push(frame);
}

const frame_of = (link) => link >= 0 ? link_frames[link] : world;

// The joint that each number of a configuration is the position of.
const variable_joints = robot_data
    ? robot_data.variables.map((index) => robot_data.joints[index]) : [];

// At first the robot rests.
const configuration = robot_data ? [...robot_data.rest] : [];

// Called where the robot has moved.
const pose_listeners = [];

function place_links() {
  for (const {joint, frame, axis} of joint_frames) {
    if (joint.variable < 0) continue;
    const position = joint.multiplier * configuration[joint.variable] + joint.offset;
    if (joint.type === "prismatic") {
      frame.position.copy(axis).multiplyScalar(position);
    } else {
      frame.quaternion.setFromAxisAngle(axis, position);
    }
  }
  world.updateMatrixWorld(true);
  for (const listener of pose_listeners) listener();
}
place_links();
