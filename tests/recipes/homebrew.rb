# Stub for Homebrew: runs install and test of a formula. The source tree is the current folder.
# Usage: homebrew.rb FORMULA WORK_DIR
require "fileutils"
require "pathname"

WORK = Pathname.new(ARGV[1])

class Pathname
  def write(text)
    File.write(to_s, text)
  end
end

module ENV_CC
  def cc
    "cc"
  end
end
ENV.extend(ENV_CC)

class Formula
  class << self
    attr_reader :test_block

    %i[desc homepage url sha256 license depends_on].each { |name| define_method(name) { |*| } }

    def on_linux
      yield
    end

    def test(&block)
      @test_block = block
    end
  end

  def prefix
    WORK/"prefix"
  end

  def bin
    prefix/"bin"
  end

  def include
    prefix/"include"
  end

  def lib
    prefix/"lib"
  end

  def testpath
    Pathname.pwd
  end

  def std_cmake_args
    %W[-DCMAKE_INSTALL_PREFIX=#{prefix} -DCMAKE_INSTALL_LIBDIR=lib -DCMAKE_BUILD_TYPE=Release
       -DCMAKE_FIND_FRAMEWORK=LAST -Wno-dev -DBUILD_TESTING=OFF]
  end

  def system(*words)
    Kernel.system(*words.map(&:to_s)) || abort("failed: #{words.join(" ")}")
  end

  def assert_path_exists(path)
    path.exist? || abort("no #{path}")
  end
end

load ARGV[0]
ENV["CMAKE_BUILD_PARALLEL_LEVEL"] ||= "2"
Ptriangle.new.install
FileUtils.mkdir_p(WORK/"test")
Dir.chdir(WORK/"test") { Ptriangle.new.instance_eval(&Ptriangle.test_block) }
