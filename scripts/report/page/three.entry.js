// What the page takes of three.js 0.160.0; three.bundle.js is made of it by
// esbuild three.entry.js --bundle --minify --format=iife --legal-comments=none, its licence before it.
import { WebGLRenderer, Scene, PerspectiveCamera, LineSegments, Vector2, Raycaster,
  BufferAttribute, InstancedBufferGeometry, InstancedBufferAttribute, ShaderMaterial } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
window.THREE = { WebGLRenderer, Scene, PerspectiveCamera, LineSegments, Vector2, Raycaster,
  BufferAttribute, InstancedBufferGeometry, InstancedBufferAttribute, ShaderMaterial, OrbitControls };
