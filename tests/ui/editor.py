"""An editor under a display, a session bus and an accessibility bus of its own, driven as a user's hands would or by its
actions over D-Bus (named in ui/spore-window.h)."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

APPLICATION, WINDOW = "org.spore.Editor", "/org/spore/Editor/window/1"
PATIENCE_S = 30
ROLES = 128  # that a query can name
WRONG = ("CRITICAL", "from markup")  # that GTK never has reason to say


def private_environment(folder):
    """The caller's environment without its desktop: nothing of the user's is read or written."""
    environment = dict(os.environ)
    for name in ("NO_AT_BRIDGE", "GTK_MODULES", "WAYLAND_DISPLAY", "AT_SPI_BUS_ADDRESS", "DBUS_SESSION_BUS_ADDRESS", "LANGUAGE",
                 "GTK_THEME"):
        environment.pop(name, None)
    run = folder / "run"
    run.mkdir(mode=0o700)
    environment.update(HOME=str(folder), XDG_RUNTIME_DIR=str(run), XDG_STATE_HOME=str(folder / "state"),
                       XDG_CONFIG_HOME=str(folder / "config"), XDG_CACHE_HOME=str(folder / "cache"),
                       XDG_DATA_HOME=str(folder / "data"), GDK_BACKEND="x11", LIBGL_ALWAYS_SOFTWARE="1",
                       GSETTINGS_BACKEND="memory", GTK_USE_PORTAL="0", GIO_USE_VFS="local", LC_ALL="C.UTF-8")
    return environment


def run_privately(script, arguments):
    """Runs the script again under Xvfb and dbus-run-session; gives its exit status."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="spore-ui-"))
    environment = private_environment(folder)
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as pipe:
            environment["DISPLAY"] = ":" + pipe.readline().strip()
        environment["SPORE_TEST_FOLDER"] = str(folder)
        return subprocess.call(["dbus-run-session", "--", sys.executable, script, *arguments], env=environment)
    finally:
        server.terminate()
        server.wait()
        shutil.rmtree(folder, ignore_errors=True)


def wait(condition, what, seconds=PATIENCE_S):
    """Waits until condition() is true and gives what it gave; the buses are served meanwhile. A condition that meets a widget which
    goes away just then, or is half made, has not come true yet; one that meets nothing else in the end fails with what it met."""
    from gi.repository import GLib
    start = time.monotonic()
    while True:
        met = None
        try:
            answer = condition()
        except AssertionError:
            raise
        except Exception as error:
            answer, met = None, error
        if answer:
            return answer
        waited = time.monotonic() - start
        if waited > seconds:
            raise AssertionError(f"waited {seconds} s in vain for {what}") from met
        while GLib.MainContext.default().iteration(False):
            pass
        time.sleep(min(max(0.05, 0.1 * waited), 0.5))  # to ask is work, for the editor too


def says(*words):
    """What a program writes."""
    return subprocess.run(words, capture_output=True, text=True).stdout


class Editor:
    """with Editor(program, ...) as editor: ... """

    def __init__(self, program, *arguments, environment=None):
        import gi
        gi.require_version("Atspi", "2.0")
        from gi.repository import Atspi, Gio
        self.atspi, self.gio = Atspi, Gio
        self.bus = Gio.bus_get_sync(Gio.BusType.SESSION, None)
        self.opened = [name for name in map(str, arguments) if name.endswith((".spore", ".sporez")) and os.path.exists(name)]
        self.process = subprocess.Popen([program, *map(str, arguments)], env={**os.environ, **(environment or {})},
                                        stderr=subprocess.PIPE, text=True, errors="replace")

    def __enter__(self):
        wait(lambda: self.describe("play") is not None, "the editor's window")
        self.application = wait(self._find_application, "the editor on the accessibility bus")
        if self.opened:
            wait(self._is_open, "the scene to be open")
        return self

    def _is_open(self):
        """What is done before would be done to the empty scene that is there until then. What cannot be opened is told."""
        name = os.path.basename(self.opened[0])
        return any(window.get_name().endswith(name) for window in self.nodes("frame")) or self.nodes("info bar|dialog|alert")

    def __exit__(self, kind, error, trace):
        if kind:
            self.keep_picture(f"failed-{self.process.pid}")
        if self.process.poll() is None:
            self.process.terminate()
        messages = self.process.communicate(timeout=20)[1]
        for line in messages.splitlines():
            if kind or any(word in line for word in WRONG):
                print("#", line)
        if not kind and any(word in messages for word in WRONG):
            raise AssertionError("the editor said what is printed above")
        wait(lambda: not self._owned(), "the editor to leave the bus")

    def _owned(self):
        from gi.repository import GLib
        answer = self.bus.call_sync("org.freedesktop.DBus", "/", "org.freedesktop.DBus", "NameHasOwner",
                                    GLib.Variant("(s)", (APPLICATION,)), None, 0, -1, None)
        return answer.unpack()[0]

    def _find_application(self):
        desktop = self.atspi.get_desktop(0)
        for i in range(desktop.get_child_count()):
            child = desktop.get_child_at_index(i)
            if child and child.get_process_id() == self.process.pid:
                return child
        return None

    # Actions.

    def _call(self, method, signature, values):
        from gi.repository import GLib
        if self.process.poll() is not None:
            raise AssertionError(f"the editor ended with {self.process.returncode}")
        try:
            return self.bus.call_sync(APPLICATION, WINDOW, "org.gtk.Actions", method, GLib.Variant(signature, values), None,
                                      0, 20000, None)
        except GLib.Error as error:
            if "ServiceUnknown" in str(error) or "UnknownMethod" in str(error) or "UnknownObject" in str(error):
                return None
            raise

    def describe(self, action):
        """(enabled, parameter type, [state]) or None: no such action, or no window."""
        try:
            answer = self._call("Describe", "(s)", (action,))
        except Exception as error:
            if "does not exist" in str(error):
                return None
            raise
        return answer.unpack()[0] if answer else None

    def enabled(self, action):
        return self.describe(action)[0]

    def state(self, action):
        return self.describe(action)[2][0]

    def act(self, action, signature=None, value=None):
        from gi.repository import GLib
        parameter = [GLib.Variant(signature, value)] if signature else []
        wait(lambda: self.enabled(action), f"{action} to be possible")
        self._call("Activate", "(sava{sv})", (action, parameter, {}))

    def act_on_program(self, action, signature, value):
        """An action of the whole program, of all its windows."""
        from gi.repository import GLib
        self.bus.call_sync(APPLICATION, WINDOW.partition("/window")[0], "org.gtk.Actions", "Activate",
                           GLib.Variant("(sava{sv})", (action, [GLib.Variant(signature, value)], {})), None, 0, 20000, None)

    # Widgets.

    def walk(self, node=None):
        node = node or self.application
        try:
            count = node.get_child_count()
        except Exception:
            return
        for i in range(min(count, 400)):
            try:
                child = node.get_child_at_index(i)
            except Exception:
                continue
            if child is None:
                continue
            yield child
            yield from self.walk(child)

    def showing(self, node):
        return node.get_state_set().contains(self.atspi.StateType.SHOWING)

    def find(self, role, name, seconds=PATIENCE_S, showing=True):
        """First widget of that role (a regular expression too) whose name, or label, matches the regular expression; showing: not scrolled away."""
        return wait(lambda: self.look(role, name, showing), f"a {role} “{name}”", seconds)

    def nodes(self, role, showing=True):
        """Widgets whose role matches the regular expression, in the order of the tree. The editor finds them by itself, in one call:
        to walk the tree takes one or more for each of hundreds of widgets."""
        atspi = self.atspi
        roles = [one for one in map(atspi.Role, range(ROLES)) if re.fullmatch(role, atspi.role_get_name(one))]
        states = atspi.StateSet.new([atspi.StateType.SHOWING] if showing else [])
        kind = atspi.CollectionMatchType
        rule = atspi.MatchRule.new(states, kind.ALL, {}, kind.ALL, roles, kind.ANY, [], kind.ALL, False)
        found = wait(lambda: self._matches(rule), "the editor to say what it shows")[0]
        for node in found:
            node.clear_cache()
        return found

    def _matches(self, rule):
        """([node, ...],), or None: it was too busy to answer."""
        from gi.repository import GLib
        try:
            return (self.atspi.Collection.get_matches(self.application, rule, self.atspi.CollectionSortOrder.CANONICAL, 0, True),)
        except GLib.Error:
            if self.process.poll() is not None:
                raise
            return None

    def look(self, role, name, showing=True):
        return next((node for node, _ in self._named(role, name, showing)), None)

    def says(self, role, name, showing=True):
        """What the regular expression finds in the name of the first such widget, or None. The name is read once: between `look` and
        `name_of` a widget can go, or say something else."""
        return next((found for _, found in self._named(role, name, showing)), None)

    def _named(self, role, name, showing):
        for node in self.nodes(role, showing):
            try:
                found = re.search(name, self.name_of(node))
            except Exception:  # it went while we looked
                continue
            if found:
                yield node, found

    def name_of(self, node):
        name = node.get_name() or ""
        if name:
            return name
        for relation in node.get_relation_set():
            if relation.get_relation_type() == self.atspi.RelationType.LABELLED_BY:
                return relation.get_target(0).get_name() or ""
        return ""

    def text_of(self, node):
        return self.atspi.Text.get_text(node, 0, -1)

    def press(self, node):
        self.atspi.Action.do_action(node, 0)

    def set_entry(self, node, text):
        """Types over what the entry holds, and Enter once that stays: the window may be about to show there what was set before."""
        def stays():
            if self.text_of(node) == text:
                return True
            self.atspi.EditableText.set_text_contents(node, text)
            return False
        wait(stays, f"{text} to stand in the entry")
        self.atspi.Action.do_action(node, 0)

    def set_number(self, node, value):
        self.atspi.Value.set_current_value(node, value)

    def choose(self, combo, text):
        """Takes the entry of a combo box's list."""
        menu = combo.get_child_at_index(0)
        names = [menu.get_child_at_index(i).get_name() for i in range(menu.get_child_count())]
        self.atspi.Selection.select_child(combo, names.index(text))

    def chosen(self, combo):
        """The entry that a combo box shows."""
        return self.atspi.Selection.get_selected_child(combo, 0).get_name()

    def drawn_view(self):
        """The viewport, as soon as its picture shows what is there by now."""
        def view():
            found = self.find(".*", "^Viewport$")
            return found if not found.get_description() else None
        return wait(view, "the picture to be drawn")

    def row(self, name):
        """Outliner row of that name, or None."""
        return self.look("table cell", f"^{re.escape(name)}$")

    def message(self):
        """What the message bar says, or None."""
        for node in self.nodes("info bar"):
            for label in self.walk(node):
                if label.get_role_name() == "label" and label.get_name():
                    return label.get_name()
        return None

    def figure(self, pattern):
        """The number that `hud` gives, as soon as it is there."""
        return wait(lambda: [number for number in [self.hud(pattern)] if number is not None], f"the figure {pattern}")[0]

    def hud(self, pattern, kind=float):
        """First group of the pattern in the figures over the viewport, as a number or what else `kind` makes; None: not there."""
        for node in self.nodes("label"):
            try:
                name = node.get_name() or ""
            except Exception:  # it went while we looked
                continue
            if name.startswith("Time "):
                found = re.search(pattern, name)
                return kind(found.group(1)) if found else None
        return None

    def time_s(self):
        return self.hud(r"Time (\d+\.\d+)")

    # Hands.

    def focus(self):
        """Gives the keyboard to the newest window that is no tooltip: there is no window manager here to do so."""
        active = self.atspi.StateType.ACTIVE

        def focused():  # the newest one may be about to close
            newest = next(one for one in reversed(self._windows()) if not self._is_tooltip(one))
            says("xdotool", "windowfocus", newest)
            return any(window.get_state_set().contains(active) for window in self.nodes("frame|dialog|file chooser"))
        wait(focused, "a window to be active")

    def _windows(self):
        return says("xdotool", "search", "--onlyvisible", "--pid", str(self.process.pid)).split()

    def _is_tooltip(self, window):
        return "TOOLTIP" in says("xprop", "-id", window, "_NET_WM_WINDOW_TYPE")

    def tooltips(self):
        """Windows that show them; the accessibility bus does not know them."""
        return [one for one in self._windows() if self._is_tooltip(one)]

    def keys(self, *keys):
        subprocess.run(["xdotool", "key", "--clearmodifiers", *keys], check=True)

    def mouse(self, *words):
        """Words of xdotool. Nothing is pressed where a tooltip lies still: the tooltip would have it."""
        words = [str(word) for word in words]
        press = next((at for at, word in enumerate(words) if word in ("click", "mousedown")), len(words))
        if words[:1] == ["mousemove"] and press < len(words):
            subprocess.run(["xdotool", *words[:press]], check=True)
            under = lambda: re.search(r"window:(\d+)", says("xdotool", "getmouselocation"))[1]
            wait(lambda: not self._is_tooltip(under()), "a tooltip to go")
            words = words[press:]
        subprocess.run(["xdotool", *words], check=True)

    def place(self, node):
        """(x, y, width, height) on the screen."""
        box = self.atspi.Component.get_extents(node, self.atspi.CoordType.SCREEN)
        return box.x, box.y, box.width, box.height

    def keep_picture(self, name):
        """Keeps a picture of the screen in the folder that SPORE_PICTURES names, for who wants to look at it."""
        folder = os.environ.get("SPORE_PICTURES")
        if not folder:
            return
        os.makedirs(folder, exist_ok=True)
        import gi
        gi.require_version("Gdk", "3.0")
        from gi.repository import Gdk
        root = Gdk.get_default_root_window()
        Gdk.pixbuf_get_from_window(root, 0, 0, root.get_width(), root.get_height()).savev(f"{folder}/{name}.png", "png", [], [])

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
