!> The version of the program.
module gudgeon_version
  implicit none
  private
  public :: program_version

  character(len=*), parameter :: program_version = '0.2.0'   !! as in fpm.toml
end module gudgeon_version
