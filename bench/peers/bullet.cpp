/// Bullet in `fase bench step`.
#include "bench/peers/bullet.hpp"

#include <LinearMath/btConvexHullComputer.h>
#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace fase::bench {
namespace {

btVector3 to_bullet(Vec3 v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btVector3 to_bullet(Vec3d v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btTransform to_bullet(const LocalPose& pose) {
    return btTransform(btQuaternion(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w),
                       to_bullet(pose.position));
}

/// Creates a hull shape. Bullet adds a margin of 4 cm to a hull, which its collision needs for speed. The hull is
/// shrunk by the same distance first, as Bullet does with boxes: the surface then matches the scene, with rounded
/// edges.
std::unique_ptr<btCollisionShape> make_hull(const ConvexHull& hull) {
    std::vector<btVector3> points;
    for (const Vec3 vertex : hull.vertices) points.push_back(to_bullet(vertex));
    constexpr btScalar max_share_of_inner_radius = 0.5f;
    auto shape = std::make_unique<btConvexHullShape>();
    btConvexHullComputer computer;
    const btScalar margin =
        computer.compute(&points[0][0], static_cast<int>(sizeof(btVector3)), static_cast<int>(points.size()),
                         shape->getMargin(), max_share_of_inner_radius);
    for (int i = 0; i < computer.vertices.size(); ++i) shape->addPoint(computer.vertices[i], false);
    shape->recalcLocalAabb();
    shape->setMargin(margin);
    return shape;
}

struct MeshTriangles {
    btTriangleMesh triangles;
    explicit MeshTriangles(const Mesh& mesh) {
        for (std::size_t t = 0; t < mesh.data->size(); ++t) {
            const auto [a, b, c] = mesh.triangle(t);
            triangles.addTriangle(to_bullet(a), to_bullet(b), to_bullet(c));
        }
    }
};

/// A mesh with the triangles that it refers to.
class MeshShape final : private MeshTriangles, public btBvhTriangleMeshShape {
public:
    explicit MeshShape(const Mesh& mesh) : MeshTriangles(mesh), btBvhTriangleMeshShape(&triangles, true) {}
};

std::unique_ptr<btCollisionShape> make_shape(const Shape& shape) {
    struct Make {
        std::unique_ptr<btCollisionShape> operator()(const Sphere& s) const {
            return std::make_unique<btSphereShape>(s.radius);
        }
        std::unique_ptr<btCollisionShape> operator()(const Box& s) const {
            return std::make_unique<btBoxShape>(to_bullet(s.half));
        }
        std::unique_ptr<btCollisionShape> operator()(const Capsule& s) const {
            return std::make_unique<btCapsuleShape>(s.radius, 2 * s.half_length);
        }
        std::unique_ptr<btCollisionShape> operator()(const Cylinder& s) const {
            return std::make_unique<btCylinderShape>(btVector3(s.radius, s.half_height, s.radius));
        }
        std::unique_ptr<btCollisionShape> operator()(const ConvexHull& s) const { return make_hull(s); }
        std::unique_ptr<btCollisionShape> operator()(const Mesh& s) const { return std::make_unique<MeshShape>(s); }
        std::unique_ptr<btCollisionShape> operator()(const HalfSpace&) const {
            return std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0));
        }
    };
    return std::visit(Make{}, shape);
}

/// The motion state of a kinematic body that moves at constant velocities.
class MovedBody final : public btMotionState {
public:
    MovedBody(const btTransform& start, btVector3 linear, btVector3 angular, btScalar dt)
        : now_(start), linear_(linear), angular_(angular), dt_(dt) {}
    void getWorldTransform(btTransform& out) const override { out = now_; }
    void setWorldTransform(const btTransform&) override {}
    void advance() {
        btTransform next;
        btTransformUtil::integrateTransform(now_, linear_, angular_, dt_, next);
        now_ = next;
    }

private:
    btTransform now_;
    btVector3 linear_, angular_;
    btScalar dt_;
};

class BulletEngine final : public Engine {
public:
    BulletEngine(const EngineOptions& options, int iterations)
        : dt_(options.settings.time_step),
          sleep_(options.settings.sleep),
          dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &solver_, &configuration_) {
        world_.getSolverInfo().m_numIterations = iterations;
        world_.setGravity(to_bullet(options.settings.gravity));
    }
    ~BulletEngine() override {
        for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    }

    Result<void> add(const scene::Scene& scene) {
        for (const Shape& shape : scene.shapes) shapes_.push_back(make_shape(shape));
        for (const scene::Body& body : scene.bodies) {
            if (auto added = add(scene, body); !added) {
                Error error = added.error();
                error.where = "bullet: body \"" + body.name + "\"";
                return error;
            }
        }
        return {};
    }

    Result<void> step() override {
        for (const auto& moved : moved_) moved->advance();
        world_.stepSimulation(dt_, 0);  // exactly one step of dt
        return {};
    }
    [[nodiscard]] std::size_t contacts() const override {
        std::size_t count = 0;
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            count += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts() > 0 ? 1 : 0;
        }
        return count;
    }
    void read_centres(std::vector<Vec3d>& out) const override {
        for (const auto& body : bodies_) {
            if (body->isStaticOrKinematicObject()) continue;
            const btVector3& centre = body->getCenterOfMassPosition();
            out.push_back({double(centre.x()), double(centre.y()), double(centre.z())});
        }
    }
    [[nodiscard]] std::string settings() const override {
        return fmt::format("Bullet {}.{:02}, {} iterations, {}", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100,
                           world_.getSolverInfo().m_numIterations, sizeof(btScalar) == 4 ? "float" : "double");
    }

private:
    Result<void> add(const scene::Scene& scene, const scene::Body& body) {
        const AxisLocks free;
        if (!(body.def.locks == free) || body.def.gravity_scale != 1) {
            return Error{Status::Unsupported, {}, "found axis locks or a gravity scale; expected a body without", {}};
        }
        if (body.colliders.empty())
            return Error{Status::Unsupported, {}, "found no collider; expected one or more", {}};
        for (const scene::Collider& collider : body.colliders) {
            if (collider.def.sensor)
                return Error{Status::Unsupported, {}, "found a sensor; expected solid colliders", {}};
        }
        MassProperties mass;
        LocalPose centre;  // centre of mass and principal axes, in the body's frame
        btVector3 moments(0, 0, 0);
        if (body.def.kind == BodyKind::Dynamic) {
            mass = mass_of(scene, body);
            const PrincipalInertia inertia = principal(mass.inertia);
            centre = {mass.centre, inertia.axes};
            moments = to_bullet(inertia.moments);
        }
        const LocalPose rotation{{}, body.def.rotation};
        btTransform start = to_bullet(rotation * centre);
        start.setOrigin(to_bullet(body.def.position) + start.getOrigin());

        btMotionState* motion = nullptr;
        if (body.def.kind == BodyKind::Kinematic) {
            moved_.push_back(std::make_unique<MovedBody>(start, to_bullet(body.def.linear_velocity),
                                                         to_bullet(body.def.angular_velocity), dt_));
            motion = moved_.back().get();
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass.mass, motion, shape_of(body, inverse(centre)), moments);
        info.m_startWorldTransform = start;
        const Material& material = body.colliders.front().def.material;
        info.m_friction = std::sqrt(material.friction);
        info.m_restitution = material.restitution;
        info.m_linearDamping = body.def.linear_damping;
        info.m_angularDamping = body.def.angular_damping;
        auto made = std::make_unique<btRigidBody>(info);
        if (body.def.kind == BodyKind::Kinematic) {
            made->setCollisionFlags(made->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
            made->setActivationState(DISABLE_DEACTIVATION);
        } else {
            made->setLinearVelocity(to_bullet(body.def.linear_velocity));
            made->setAngularVelocity(to_bullet(body.def.angular_velocity));
        }
        if (!sleep_) made->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(made.get());
        bodies_.push_back(std::move(made));
        return {};
    }

    static MassProperties mass_of(const scene::Scene& scene, const scene::Body& body) {
        if (body.def.mass) return *body.def.mass;
        std::vector<MassProperties> parts;
        for (const scene::Collider& collider : body.colliders) {
            parts.push_back(
                transformed(mass_properties(scene.shapes[collider.shape], collider.def.density), collider.def.pose));
        }
        return combined(parts);
    }

    /// Returns the shape of a body. `body_in_centre`: the body's frame relative to its centre of mass.
    btCollisionShape* shape_of(const scene::Body& body, const LocalPose& body_in_centre) {
        const LocalPose first = body_in_centre * body.colliders.front().def.pose;
        if (body.colliders.size() == 1 && first == LocalPose{}) return shapes_[body.colliders.front().shape].get();
        auto compound = std::make_unique<btCompoundShape>();
        for (const scene::Collider& collider : body.colliders) {
            compound->addChildShape(to_bullet(body_in_centre * collider.def.pose), shapes_[collider.shape].get());
        }
        compounds_.push_back(std::move(compound));
        return compounds_.back().get();
    }

    btScalar dt_;
    bool sleep_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btCompoundShape>> compounds_;
    std::vector<std::unique_ptr<MovedBody>> moved_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_;
};

Result<std::unique_ptr<Engine>> make(const scene::Scene& scene, const EngineOptions& options, int iterations) {
    auto engine = std::make_unique<BulletEngine>(options, iterations);
    if (auto added = engine->add(scene); !added) return added.error();
    return std::unique_ptr<Engine>(std::move(engine));
}

}  // namespace

Result<std::unique_ptr<Engine>> make_bullet(const scene::Scene& scene, const EngineOptions& options) {
    return make(scene, options, btContactSolverInfo().m_numIterations);
}

Result<std::unique_ptr<Engine>> make_bullet_50(const scene::Scene& scene, const EngineOptions& options) {
    return make(scene, options, 50);
}

}  // namespace fase::bench
