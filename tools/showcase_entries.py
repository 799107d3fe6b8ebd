# SPDX-License-Identifier: BSD-3-Clause
"""The entries of tools/showcase.py: title, options of `rastrum`, and the file that f3d and VTK also draw."""
import dataclasses


@dataclasses.dataclass
class Entry:
    name: str
    title: str
    command: str  # DATA is the folder of real data, MADE that of showcase_data.py's files
    peer_file: str = ""  # for f3d and VTK; with DATA or MADE as in the command
    size: tuple = (640, 480)

    @property
    def files(self):
        """Returns the files of the command, each with its folder."""
        words = [w.strip("'") for w in self.command.replace("@", " ").replace(":", " ").split()]
        return [w for w in words if w.startswith(("DATA/", "MADE/"))]


SIZE = "--size 640x480"
PAGE = f"{SIZE} --background '#ffffff'"
NIGHT = f"{SIZE} --background '#20242c'"
# Used where the options say more than the file.
SMOOTH = "--samples 4"

FIRST = [  # a file without further options
    Entry("bunny", "The bunny", f"render DATA/small/stanford-bunny.obj {PAGE}", "DATA/small/stanford-bunny.obj"),
    Entry("dragon", "A dragon", f"render DATA/big/dragon_348k.ply {PAGE}", "DATA/big/dragon_348k.ply"),
    Entry("brain", "A million triangles of a brain", f"render DATA/big/brain_iso126_1033k.ply {PAGE}",
          "DATA/big/brain_iso126_1033k.ply"),
    Entry("stl_part", "A part from CAD, z upwards", f"render DATA/small/42400-IDGH.stl {PAGE} --up z",
          "DATA/small/42400-IDGH.stl"),
    Entry("rocker_arm", "A rocker arm", f"render DATA/small/rocker-arm.obj {PAGE}", "DATA/small/rocker-arm.obj"),
    Entry("spot", "Spot", f"render DATA/small/spot/spot_triangulated.obj {PAGE} --azimuth 150",
          "DATA/small/spot/spot_triangulated.obj"),
    Entry("engine", "An engine", f"render DATA/depth/2CylinderEngine.glb {PAGE}", "DATA/depth/2CylinderEngine.glb"),
    Entry("sponza", "Sponza, from inside", f"render DATA/sponza/sponza.obj {PAGE} --eye -1100,180,0 --target 0,260,-40 --fov 65 "
          f"{SMOOTH} --lights studio --occlusion --occlusion-radius 60"),
]

NUMBERS = [
    Entry("notch", "Stress around a notch, with isolines", f"render MADE/notch.ply {PAGE} {SMOOTH} --scalars stress "
          "--cmap turbo --isolines 12 --bar Stress --bar-unit Pa", "MADE/notch.ply"),
    Entry("can", "A crushed can: strain, a number for each face", f"render MADE/can.ply {PAGE} {SMOOTH} --scalars strain "
          "--cmap inferno --bar 'Plastic strain' --occlusion --up z --azimuth 30", "MADE/can.ply"),
    Entry("carotid", "Speed of blood at a carotid's wall", f"render MADE/carotid.ply {PAGE} {SMOOTH} --scalars speed --cmap plasma "
          "--bar Speed --bar-unit cm/s --up z", "MADE/carotid.ply"),
    Entry("carotid_log", "The same by factors, and what lies beyond a range", f"render MADE/carotid.ply {PAGE} {SMOOTH} "
          "--scalars speed --log --range 0.1,10 --below '#303030' --above '#ff00ff' --cmap cividis --bar Speed --bar-unit cm/s --up z"),
    Entry("disk", "Temperature in a reactor, eight steps", f"render MADE/disk.ply {PAGE} {SMOOTH} --scalars temperature --cmap "
          "coolwarm --steps 8 --bar Temperature --bar-unit K --edges --edge-angle 30 --azimuth 150", "MADE/disk.ply"),
    Entry("brain_numbers", "A scan's numbers on its isosurface", f"render DATA/big/brain_iso126_1033k.ply {PAGE} {SMOOTH} "
          "--scalars quality --cmap Spectral_r --bar Quality --occlusion"),
    Entry("hydrogen", "Densities of hydrogen: opacity by number, every layer in its order",
          f"render MADE/hydrogen.ply {PAGE} {SMOOTH} --scalars density --log --cmap viridis --scalar-opacity 0.02:0.08,0.6:0.9 "
          "--bar Density --lights studio", "MADE/hydrogen.ply"),
    Entry("knot_opacity", "Glass below, stone above", f"render builtin:torus_knot {PAGE} {SMOOTH} --scalars z --cmap coolwarm --symmetric "
          "--scalar-opacity -0.6:0.15,0.6:1 --bar z"),
    Entry("protein", "A protein's atoms by chain: categories", f"render MADE/protein.ply {NIGHT} {SMOOTH} --scalars chain "
          "--cmap Set2 --categories 65,66,67 --point-size 7 --edl --edl-strength 0.03 --shader flat --title '7DDO by chain'"),
    Entry("dna", "DNA and its repressor by element", f"render MADE/dna.ply {PAGE} {SMOOTH} --scalars element --cmap tab10 "
          "--categories 1,6,7,8,15,16 --point-size 11 --edl --edl-strength 0.03 --shader flat --bar 'Atomic number'"),
    Entry("protein_factor", "The protein's temperature factors", f"render MADE/protein.ply {NIGHT} {SMOOTH} --scalars bfactor "
          "--cmap YlOrRd --point-size 7 --edl --edl-strength 0.03 --shader flat --bar 'B factor' --bar-unit 'Å²'"),
    Entry("gyroid_numbers", "Distance on a gyroid", f"render 'builtin:gyroid?cells=64' {PAGE} {SMOOTH} --scalars distance --cmap turbo "
          "--isolines 20 --bar Distance --bar-unit m --occlusion"),
    Entry("tubes_numbers", "Numbers along a tube", f"render 'builtin:tube?p=3&q=5&segments=600&radius=0.12' {PAGE} {SMOOTH} --scalars y "
          "--cmap twilight --isolines 10 --bar Height --occlusion"),
    Entry("spheres_numbers", "Spheres, a number each", f"render 'builtin:spheres?count=800' {PAGE} {SMOOTH} --scalars distance --cmap magma "
          "--bar Distance --occlusion"),
]

LIGHT = [
    Entry("headlight", "A head light alone", f"render DATA/small/rocker-arm.obj {PAGE} {SMOOTH} --lights headlight"),
    Entry("directional", "One directional light, with its shadow", f"render DATA/small/cow.obj {PAGE} {SMOOTH} --light "
          "ambient:intensity=0.2 --light directional:-1,-1.3,-0.6:intensity=0.8 --shadows --azimuth 20"),
    Entry("lamps", "Two coloured lamps and a spot", f"render builtin:torus_knot {NIGHT} {SMOOTH} --light ambient:intensity=0.12 --light "
          "'point:0.4,1.6,0.4:intensity=1.5:color=#ffc080' --light 'point:-2,-0.4,1.4:intensity=1.2:color=#4080ff' "
          "--light 'spot:2,0.6,2.4:towards=-2,-1,-2.4:inner=6:outer=9:intensity=3'"),
    Entry("hemisphere", "Sky above, earth below", f"render DATA/small/suzanne.obj {PAGE} {SMOOTH} --light "
          "'hemisphere:0,1,0:color=#c8dcff:below=#503820:intensity=0.8' --light directional:-1,-1,-1:intensity=0.4 --azimuth -20"),
    Entry("spot_shadows", "A spot's shadows", "render MADE/floor.obj builtin:teapot builtin:torus_knot@x=-3.4,y=1,z=1.6 "
          f"{SIZE} --background '#101418' {SMOOTH} --eye 3,6,8 --target -0.6,0.8,0 --fov 45 --light ambient:intensity=0.12 "
          "--light 'spot:4,6,5:towards=-5,-5.4,-5:inner=14:outer=24:intensity=75:color=#ffe8c8' --shadows"),
    Entry("environment_room", "Metal and varnish in a room, rougher to the right", f"render MADE/balls.obj {SIZE} {SMOOTH} --view front "
          "--azimuth 25 --elevation 8 --fov 40 --shader material --light environment:room --environment-behind"),
    Entry("environment_sky", "The same under the sky", f"render MADE/balls.obj {SIZE} {SMOOTH} --view front "
          "--azimuth 25 --elevation 8 --fov 40 --shader material --light environment:sky --environment-behind --tone aces"),
    Entry("environment_dragon", "A dragon by the light of the sky", f"render DATA/big/dragon_348k.ply {SIZE} {SMOOTH} --view front --elevation 4 "
          "--shader phong --light environment:sky --light directional:-0.5,-0.8,-0.4:intensity=0.4 --shadows --environment-behind"),
    Entry("tone_none", "Light above 1, cut", f"render 'builtin:torus_knot@color=#b0583a' {NIGHT} {SMOOTH} --shader material "
          "--light ambient:intensity=0.2 --light 'point:0.6,1.6,1.2:intensity=12'"),
    Entry("tone_aces", "The same, mapped", f"render 'builtin:torus_knot@color=#b0583a' {NIGHT} {SMOOTH} --shader material "
          "--light ambient:intensity=0.2 --light 'point:0.6,1.6,1.2:intensity=12' --tone aces"),
    Entry("plain", "What is compared: the fixed light, from the front, one sample",
          f"render DATA/small/stanford-bunny.obj {PAGE} --look plain"),
]

DEPTH = [
    Entry("occlusion", "Ambient occlusion alone", f"render DATA/big/brain_iso126_1033k.ply {PAGE} {SMOOTH} --light ambient --occlusion"),
    Entry("dome", "A brain's vertices as points, by eye-dome lighting",
          f"render MADE/brain_points.ply {NIGHT} --shader flat --point-size 3 --edl --edl-strength 0.7 --samples 4"),
    Entry("silhouettes", "Suzanne with silhouettes", f"render DATA/small/suzanne.obj {PAGE} {SMOOTH} --silhouettes --azimuth -20"),
    Entry("edges", "The mesh on its surface", f"render DATA/small/cow.obj {PAGE} {SMOOTH} --edges --azimuth 20"),
    Entry("creases", "Feature edges of a part", f"render DATA/small/42400-IDGH.stl {PAGE} {SMOOTH} --up z --edges --edge-angle 30 "
          "--edge-width 1.5 --occlusion"),
    Entry("wire", "A wireframe", f"render DATA/small/teapot.obj {PAGE} {SMOOTH} --shader wireframe"),
    Entry("normals", "Normals as colours", f"render DATA/big/dragon_348k.ply {PAGE} {SMOOTH} --shader normal"),
    Entry("ids", "Triangles as colours", f"render DATA/small/rocker-arm.obj {PAGE} {SMOOTH} --shader id"),
]

WORDS = [
    Entry("bounds", "A part and its size", f"render DATA/small/42400-IDGH.stl {PAGE} {SMOOTH} --up z --lights studio --occlusion --bounds --axes"),
    Entry("words", "Title, captions, axes", f"render 'builtin:gyroid?cells=64' {PAGE} {SMOOTH} --lights studio --occlusion --bounds --axes "
          "--title 'Gyroid' --caption 'sin x cos y + sin y cos z + sin z cos x = 0' --caption 'α = 3°, ρ ≤ 2·10⁻³ kg/m³'"),
    Entry("all_of_it", "All of it", f"render MADE/notch.ply {SIZE} --background '#181c24' {SMOOTH} --scalars stress --cmap turbo --isolines 16 --isoline-color white --azimuth -20 "
          "--bar Stress --bar-unit Pa --bounds --axes --title 'Notched bar under tension' --occlusion"),
]

LAYERS = [
    Entry("engine_glass", "An engine's insides, every layer in its exact order",
          f"render DATA/depth/2CylinderEngine.glb {PAGE} {SMOOTH} --lights studio --opacity 0.3"),
    Entry("engine_section", "A section by a clip plane", f"render DATA/depth/2CylinderEngine.glb {PAGE} {SMOOTH} --lights studio --occlusion "
          "--view front --azimuth 20 --elevation 25 --clip-plane 0,0,-1,0"),
    Entry("hair", "Ribbons of hair, blended", "render DATA/depth/ratboy_mohawk_ribbons_138k.ply@color=#7a4a1c "
          f"{PAGE} {SMOOTH} --lights studio --opacity 0.8 --view right --zoom 1.1"),
    Entry("pine", "Cut-out leaves", f"render DATA/alpha/smallpine/scene.gltf {PAGE}"),
    Entry("alpha", "glTF's alpha modes", f"render DATA/alpha/AlphaBlendModeTest.glb {PAGE} --view front", "DATA/alpha/AlphaBlendModeTest.glb"),
    Entry("glass", "Glass around stone", "render 'builtin:torus_knot@color=#5b8fd6,opacity=0.4' 'builtin:sphere@scale=0.7,color=#d6a35b' "
          f"{PAGE} {SMOOTH} --lights studio"),
]

SHAPES = [
    Entry("spheres", "Two thousand exact spheres", f"render 'builtin:spheres?count=2000' {PAGE}"),
    Entry("tube", "A tube round a torus knot", f"render 'builtin:tube?p=3&q=5&segments=600&radius=0.12@color=#4a7fb5' {PAGE}"),
    Entry("cylinders", "Cylinders", f"render 'builtin:cylinders?count=800' {PAGE}"),
    Entry("discs", "Discs, translucent", f"render 'builtin:discs?count=600' {PAGE} --opacity 0.6"),
    Entry("hairball", "A hairball", f"render 'builtin:hairball?strands=6000&width=0.006' {NIGHT}"),
    Entry("demo", "Shapes on a table", "render 'builtin:teapot?n=24' 'builtin:torus_knot?x=-4.6,y=1.7,z=-1.5,scale=1.1' "
          f"'builtin:gyroid?x=5.2,y=1.5,z=-2,scale=1.3' {NIGHT} --eye 0.5,5.2,10.5 --target 0.3,1.1,0 --fov 50"),
]

TERRAIN = [
    Entry("hills", "Hills of noise with sharp shadows", "terrain --function noise --position 300,900 --distance 2500 "
          f"--fog 0.0012,400 --shadows sharp --sun 300,25 --sky '#98b4e0' {SIZE}"),
    Entry("hills_soft", "The same by a low sun with soft shadows", "terrain --function noise --position 300,900 --distance 2500 "
          f"--fog 0.0008,600 --shadows soft --sun 280,8 --sky '#c8a888' {SIZE}"),
    Entry("hills_lights", "The same under a sky, with a sun of its own and a tone", "terrain --function noise --position 300,900 "
          "--altitude 112 --horizon 110 --distance 2500 --light environment:sky --light directional:0.8,-0.5,0.3:intensity=2 "
          f"--tone aces --exposure -0.8 --shadows sharp --environment-behind --mesh builtin:teapot@x=345,y=780,scale=9 {SIZE}"),
    Entry("jotunheimen_heights", "Their heights as numbers, with a bar, axes and the map's box", "terrain --height "
          "DATA/terrain/jotunheimen512.bin --scalars height --cmap viridis --bar Height --tile clamp --axes --bounds --shadows sharp "
          f"--sun 300,30 {SIZE}"),
    Entry("jotunheimen", "Real mountains", "terrain --height DATA/terrain/jotunheimen512.bin --color "
          f"DATA/terrain/jotunheimen-texture.jpg --shadows soft --sun 300,20 --sky '#98b4e0' {SIZE}"),
]

ENTRIES = FIRST + NUMBERS + LIGHT + DEPTH + WORDS + LAYERS + SHAPES + TERRAIN
