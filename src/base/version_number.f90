!> The version of the program.
module version_number
  implicit none
  private
  public :: program_version

  character(len=*), parameter :: program_version = '0.3.0'   !! as in fpm.toml
end module version_number
