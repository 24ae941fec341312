"""Room graph of a tree (new layout if it exists, else FILES applied virtually): python graph.py TREE"""
import ast, sys
from pathlib import Path
sys.path.insert(0, str(Path(__file__).parent))
from rooms import FILES
root = Path(sys.argv[1]) / "src/collisions"
mods = {}
for p in root.rglob("*.py"):
    rel = p.relative_to(root).as_posix()
    mods[rel] = p
def modname(rel): 
    parts = rel[:-3].split("/")
    return tuple(parts[:-1] if parts[-1]=="__init__" else parts)
known = {modname(r): r for r in mods}
def edges(rel):
    out = {}
    tree = ast.parse(mods[rel].read_text())
    pkg = rel.split("/")[:-1]
    def walk(node, typed):
        for c in ast.iter_child_nodes(node):
            if isinstance(c, ast.If) and ast.unparse(c.test)=="TYPE_CHECKING":
                continue
            if isinstance(c, ast.ImportFrom) and c.level:
                base = tuple(pkg[:len(pkg)-c.level+1]) + tuple((c.module or "").split(".") if c.module else ())
                for a in c.names:
                    full = base+(a.name,)
                    t = known.get(full) or known.get(base)
                    if full in known and base in known and base and False: pass
                    out.setdefault(t, set()).add(a.name)
            walk(c, typed)
    walk(tree, False)
    return out
E = {r: edges(r) for r in mods}
def room(rel):
    new = FILES.get(rel, rel)
    if new=="reconstruct/__init__.py": return "reconstruct"
    return new.split("/")[0] if "/" in new else new
G = {}
for r, ts in E.items():
    for t, names in ts.items():
        if t and room(r)!=room(t):
            G.setdefault((room(r), room(t)), []).append((FILES.get(r,r), FILES.get(t,t), sorted(names)))
rooms = sorted({room(r) for r in mods})
# tarjan-ish: find cycles via removing
def reach(a):
    seen=set(); st=[a]
    while st:
        x=st.pop()
        for (f,t) in G:
            if f==x and t not in seen: seen.add(t); st.append(t)
    return seen
R={a:reach(a) for a in rooms}
print(len(rooms),"rooms",len(G),"arrows")
for a in rooms:
    print(a, "->", sorted({t for f,t in G if f==a}))
print("pairs in circles:")
for (f,t),es in sorted(G.items()):
    if f in R[t]:
        print(f,"->",t)
        for e in es: print("     ",e)
# depth of files
import functools
@functools.cache
def depth(r):
    return 1+max([depth(t) for t in E[r] if t and t!=r and mods[t].stem!="__init__"] or [0])
try: print("file floors", max(depth(r) for r in mods))
except RecursionError: print("file cycle")
