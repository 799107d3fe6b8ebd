"""What tools/showcase.py draws: a title, the options of `rastrum`, and the file that others draw, too."""
import dataclasses


@dataclasses.dataclass
class Entry:
    name: str
    title: str
    command: str  # DATA stands for the folder of real data
    peer_file: str = ""  # of that folder, for f3d and VTK
    size: tuple = (640, 480)

    @property
    def needs(self):
        """Files of the data folder."""
        words = self.command.replace("@", " ").split()
        return [w.strip("'").removeprefix("DATA/") for w in words if w.strip("'").startswith("DATA/")]


PLAIN = "--samples 4 --size 640x480 --background '#f4f4f2'"
NIGHT = "--samples 4 --size 640x480 --background '#20242c'"

ENTRIES = [
    Entry("bunny", "The bunny, occluded", f"render DATA/small/stanford-bunny.obj {PLAIN} --occlusion",
          "small/stanford-bunny.obj"),
    Entry("dragon", "A dragon, three-quarter", f"render DATA/big/dragon_348k.ply {PLAIN} --view iso --occlusion",
          "big/dragon_348k.ply"),
    Entry("brain", "An isosurface of a million triangles", f"render DATA/big/brain_iso126_1033k.ply {PLAIN} --occlusion "
          "--azimuth 35 --elevation 15", "big/brain_iso126_1033k.ply"),
    Entry("teapot", "The teapot", f"render DATA/small/teapot.obj {PLAIN} --occlusion --azimuth 20 --elevation 20",
          "small/teapot.obj"),
    Entry("suzanne", "Suzanne with silhouettes", f"render DATA/small/suzanne.obj {PLAIN} --silhouettes --azimuth 25",
          "small/suzanne.obj"),
    Entry("rocker_arm", "A part from CAD, with its axes", f"render DATA/small/rocker-arm.obj {PLAIN} --view iso --occlusion "
          "--axes --title 'Rocker arm'", "small/rocker-arm.obj"),
    Entry("stl_part", "An STL file and its size", f"render DATA/small/42400-IDGH.stl {PLAIN} --view iso --up z --occlusion "
          "--bounds", "small/42400-IDGH.stl"),
    Entry("cow", "Facets and edges", f"render DATA/small/cow.obj {PLAIN} --normals face --silhouettes --azimuth 40 "
          "--elevation 15", "small/cow.obj"),
    Entry("cow_wire", "A wireframe", f"render DATA/small/cow.obj {PLAIN} --shader wireframe --azimuth 40 --elevation 15"),
    Entry("spot", "Spot", f"render DATA/small/spot/spot_triangulated.obj@ry=180 {PLAIN} --azimuth 30 --elevation 15 --occlusion",
          "small/spot/spot_triangulated.obj"),
    Entry("engine", "An engine", f"render DATA/depth/2CylinderEngine.glb {PLAIN} --view iso --occlusion",
          "depth/2CylinderEngine.glb"),
    Entry("engine_glass", "Its insides, every layer in its exact order",
          f"render DATA/depth/2CylinderEngine.glb {PLAIN} --view iso --opacity 0.3"),
    Entry("engine_section", "A section by a clip plane",
          f"render DATA/depth/2CylinderEngine.glb {PLAIN} --azimuth 20 --elevation 25 --clip-plane 0,0,-1,0 --occlusion"),
    Entry("hair", "Ribbons of hair, blended", f"render DATA/depth/ratboy_mohawk_ribbons_138k.ply@color=#7a4a1c {PLAIN} --opacity 0.8 "
          "--azimuth 80", "depth/ratboy_mohawk_ribbons_138k.ply"),
    Entry("sponza", "Sponza, from inside", f"render DATA/sponza/sponza.obj {PLAIN} --eye -1100,180,0 --target 0,260,-40 "
          "--fov 65", "sponza/sponza.obj"),
    Entry("pine", "Cut-out leaves", f"render DATA/alpha/smallpine/scene.gltf {PLAIN} --elevation 10"),
    Entry("alpha", "glTF's alpha modes", f"render DATA/alpha/AlphaBlendModeTest.glb {PLAIN}", "alpha/AlphaBlendModeTest.glb"),
    Entry("normals", "Normals as colours", f"render DATA/big/dragon_348k.ply {PLAIN} --shader normal --view iso"),
    Entry("depth", "Depth as grey", f"render DATA/big/dragon_348k.ply {PLAIN} --shader depth --view iso"),
    Entry("ids", "Triangles as colours", f"render DATA/small/rocker-arm.obj {PLAIN} --shader id --view iso"),
    Entry("points", "A mesh's vertices as points, lit by eye-dome lighting",
          f"render DATA/big/brain_iso126_1033k.ply {NIGHT} --shader flat --edl --azimuth 35 --elevation 15"),
    Entry("spheres", "A thousand exact spheres", f"render 'builtin:spheres?count=2000' {PLAIN} --occlusion --view iso"),
    Entry("tube", "A tube round a torus knot", f"render 'builtin:tube?p=3&q=5&segments=600&radius=0.12@color=#4a7fb5' {PLAIN} "
          "--occlusion --azimuth 20 --elevation 30"),
    Entry("cylinders", "Cylinders", f"render 'builtin:cylinders?count=800' {PLAIN} --occlusion --view iso"),
    Entry("discs", "Discs, translucent", f"render 'builtin:discs?count=600' {PLAIN} --opacity 0.6 --view iso"),
    Entry("gyroid", "A gyroid, cut", f"render 'builtin:gyroid?cells=96' {PLAIN} --occlusion --view iso "
          "--clip-plane=-1,-1,-1,0.6 --bounds"),
    Entry("hairball", "A hairball", f"render 'builtin:hairball?strands=6000&width=0.006' {NIGHT} --occlusion"),
    Entry("glass", "Glass before stone", "render 'builtin:torus_knot@color=#5b8fd6,opacity=0.4' "
          f"'builtin:sphere@scale=0.7,color=#d6a35b' {PLAIN} --view iso"),
    Entry("demo", "Shapes", f"render 'builtin:teapot?n=24' 'builtin:torus_knot?x=-4.6,y=1.7,z=-1.5,scale=1.1' "
          f"'builtin:gyroid?x=5.2,y=1.5,z=-2,scale=1.3' {NIGHT} --eye 0.5,5.2,10.5 --target 0.3,1.1,0 --fov 37 --occlusion"),
    Entry("hills", "Hills of noise with sharp shadows", "terrain --function noise --position 300,900 --distance 2500 "
          "--fog 0.0012,400 --shadows sharp --sun 300,25 --sky '#98b4e0' --size 640x480"),
    Entry("hills_soft", "The same by a low sun with soft shadows", "terrain --function noise --position 300,900 --distance 2500 "
          "--fog 0.0008,600 --shadows soft --sun 280,8 --sky '#c8a888' --size 640x480"),
    Entry("jotunheimen", "Real mountains", "terrain --height DATA/terrain/jotunheimen512.bin --color "
          "DATA/terrain/jotunheimen-texture.jpg --shadows soft --sun 300,20 --sky '#98b4e0' --size 640x480"),
]
